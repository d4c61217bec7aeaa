// Obstacles as GeoJSON: our own files and other people's.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/core/footprint.h"
#include "runtime/base/error.h"

namespace flaneur {

enum class GeoJsonUnits { kAuto, kMetres, kDegrees };

struct ReadGeoJsonOptions {
  // kAuto: metres where the file has our member "flaneur"; else what its member "crs" says; else longitude and
  // latitude, as the standard has it.
  GeoJsonUnits units = GeoJsonUnits::kAuto;
  std::string system;    // such as "EPSG:25832": of the coordinates, whatever the file says
  bool swapped = false;  // x and y stand the other way round
};

struct Way {
  std::string name;
  std::vector<Point2> points;
};
// A point of kind door, exit or spawn.
struct GatePoint {
  std::string name;
  Point2 at;
  bool is_exit = false;
};

// What is wrong with a file that can be read all the same.
// kElsewhere: what it says of its place contradicts itself or the town.
enum class GeoJsonFaultKind { kBrokenFeature, kOtherSystem, kUnknownSystem, kElsewhere };
struct GeoJsonFault {
  GeoJsonFaultKind kind;
  std::string feature, message;
};

struct GeoJsonFile {
  Footprints footprints;  // local metres
  // Obstacle i's rings that end without coming back to their first point: 0 the outer one, then the holes. A polygon
  // without any point has ring 0 in it, a circle none.
  std::vector<std::vector<int>> open_rings;
  std::vector<Way> ways;  // lines that are streets: all but barriers, waterways, railways, tunnels and the like
  std::vector<GatePoint> places;
  std::vector<GeoJsonFault> faults;
  int skipped = 0;                   // features that are nothing of all this
  Point2 moved_m;                    // add to a coordinate to get the file's own, where they were only moved
  std::string system, local_system;  // else: of the file's coordinates, and of ours
  Point2 local_origin_m;             // add to our coordinates to get those of local_system
  bool has_origin = true;            // false: one of our own files that does not say where it lies
  bool place_is_sure = false;        // it says twice where it lies, and both agree
  // Of one of our own files in degrees: what its town's coordinates are in, where the town itself does not say.
  std::string town_system;
  Point2 town_origin_m;
};

// Polygons, multipolygons (one obstacle each part), points with `radius_m`, lines, and points of kind door, exit,
// spawn. Rings come as they stand, only the repeated last point is dropped: broken rings are for the check to find.
// Names that are missing are made up, names that repeat get a number. Longitudes and latitudes, and maps that are
// stretched by more than 0.5 %, become local metres; projected coordinates are moved near zero. Coordinates that cannot
// be in the system stated are a fault, and read as what they look like. Errors: unreadable, not JSON, no GeoJSON; a
// system asked for that is not known.
Error ReadGeoJson(const std::filesystem::path& path, const ReadGeoJsonOptions& options, GeoJsonFile* file);

// Into the coordinates of a town that was moved near zero by `origin_m`; `reference_system` of its own ones, empty
// where not known. Neither known: nothing is moved. What lies in no common system or beyond 100 km is a fault
// (kElsewhere), and stays where it is. A town that does not name its system has the one that our own file in degrees
// names. Errors: none but PROJ's own.
Error MoveToTown(const std::string& reference_system, Point2 origin_m, GeoJsonFile* file);

// All points, by so much; places in the file stay known.
void MoveBy(Point2 shift_m, GeoJsonFile* file);

// Back into the file's own coordinates.
std::vector<Point2> ToFileCoordinates(const GeoJsonFile& file, std::vector<Point2> points);

// Coordinates to 0.1 mm. `source_system`: of the town's file, where it was brought into `footprints.reference_system`.
// Errors: as for WriteFile.
Error WriteGeoJson(const std::filesystem::path& path, const Footprints& footprints,
                   const std::string& source_system = {});

// Longitudes and latitudes on WGS 84, as the standard has it, to 0.1 mm. Errors: as for CheckMapPlace and WriteFile.
Error WriteLongitudeLatitude(const std::filesystem::path& path, const Footprints& footprints);

}  // namespace flaneur
