// Coordinate systems of maps, by PROJ.
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/footprint.h"
#include "runtime/base/error.h"

namespace flaneur {

// Longitude and latitude in degrees on WGS 84, as GeoJSON has it.
inline constexpr const char* kLongitudeLatitude = "OGC:CRS84";

// Of each coordinate by itself, so that a few stray points do not move it; (0, 0) where none is finite.
Point2 Median(const std::vector<Point2>& points);

// A transverse Mercator map of metres that touches the ellipsoid at the origin: x east, y north, lengths true to 1 mm
// in 100 m as far as 28 km east and west of it. The origin is rounded to 0.01 degrees, so that a town keeps its
// coordinates when an obstacle is added.
std::string LocalMapSystem(Point2 longitude_latitude);

// x is always east or longitude. Points that have no image become NaN. `from` and `to`: what PROJ can make a system of,
// such as "EPSG:25832"; of those with heights the part for the plane. All points go the same way, the best one at their
// middle, and there and back is where they were, to 0.01 mm. Errors: a name that PROJ does not know.
Error TransformPoints(const std::string& from, const std::string& to, std::vector<Point2>* points);

// On the system's own datum, up to some hundred metres off: at once, where to transform a place looks for the best way
// there first. False where the system is not known or the point has no image.
bool FindRoughPlace(const std::string& system, Point2 at, Point2* longitude_latitude);

struct MapSystem {
  bool degrees = false;      // or grads: longitude and latitude, of which
  double unit_deg = 1;       // one is so many degrees,
  double meridian_deg = 0;   // and longitudes count from here, east of Greenwich
  bool north_first = false;  // its authority gives latitude or northing as the first coordinate
  std::string other_unit;    // "US survey foot": of coordinates that are neither degrees nor metres
  bool has_area = false;
  double west = -180, south = -90, east = 180, north = 90;  // where it is meant to be used, degrees
};
Error FindMapSystem(const std::string& name, MapSystem* system);

// Of coordinates of a system of degrees, longitude first: degrees east of Greenwich and north, on its own datum.
Point2 FromGreenwich(const MapSystem& system, Point2 longitude_latitude);

// The fitting system in metres, x east and y north, for a town at this place: the UTM zone on the same datum where
// there is one, else on WGS 84, near the poles a local map.
std::string MetricSystemAt(const std::string& system, Point2 longitude_latitude);

// The projected systems in which `at` is at this place on earth, to within_m; the nearest first.
std::vector<std::string> SystemsThatPut(Point2 at, Point2 longitude_latitude, double within_m);

// Whether lengths are true to 0.5 % at this place of a projected system, with x about east and y about north. Those of
// EPSG:3857 are not, and the axes of EPSG:2065 point south and west.
bool IsMapOfMetres(const std::string& system, Point2 at_m);

// Within the area of use, or up to `slack_deg` beside it.
bool IsUsedAt(const MapSystem& system, Point2 longitude_latitude, double slack_deg = 3);

// Whether these can be coordinates of a town in this system. A place a little beside the area that it is for gives a
// warning: they may be a neighbouring zone's. Errors: a name that PROJ does not know, a system of degrees or feet,
// degrees in a system of metres, a place far outside of the area; each says what to do.
Error CheckMapPlace(const std::string& system, Point2 at_m, std::vector<std::string>* warnings = nullptr);

}  // namespace flaneur
