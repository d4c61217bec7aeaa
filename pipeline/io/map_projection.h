// Coordinate systems of maps, by PROJ.
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/footprint.h"
#include "runtime/base/error.h"

namespace flaneur {

// Longitude and latitude in degrees on WGS 84, as GeoJSON has it.
inline constexpr const char* kLongitudeLatitude = "OGC:CRS84";

// A transverse Mercator map of metres that touches the ellipsoid at the origin: x east, y north, lengths true to 1 mm
// in 100 m as far as 28 km east and west of it. The origin is rounded to 0.01 degrees, so that a town keeps its
// coordinates when an obstacle is added.
std::string LocalMapSystem(Point2 longitude_latitude);

// x is always east or longitude. Points that have no image become NaN. `from` and `to`: what PROJ can make a system of,
// such as "EPSG:25832". Errors: a name that PROJ does not know.
Error TransformPoints(const std::string& from, const std::string& to, std::vector<Point2>* points);

struct MapSystem {
  bool degrees = false;
  std::string other_unit;  // "US survey foot": of coordinates that are neither degrees nor metres
  bool has_area = false;
  double west = -180, south = -90, east = 180, north = 90;  // where it is meant to be used, degrees
};
Error FindMapSystem(const std::string& name, MapSystem* system);

// Within the area of use, or up to `slack_deg` beside it.
bool IsUsedAt(const MapSystem& system, Point2 longitude_latitude, double slack_deg = 3);

// Whether these can be coordinates of a town in this system. A place a little beside the area that it is for gives a
// warning: they may be a neighbouring zone's. Errors: a name that PROJ does not know, a system of degrees or feet,
// degrees in a system of metres, a place far outside of the area; each says what to do.
Error CheckMapPlace(const std::string& system, Point2 at_m, std::vector<std::string>* warnings = nullptr);

}  // namespace flaneur
