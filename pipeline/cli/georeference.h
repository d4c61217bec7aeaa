// Where on earth a town stands, as its file, tour.toml or an option says.
#pragma once
#include <filesystem>
#include <string>

#include "pipeline/core/scene.h"
#include "runtime/base/error.h"

namespace flaneur {

struct Georeference {
  std::string crs;  // of a map in metres, such as "EPSG:25832"; empty: as the town's file says; "none": not known
  Point2 origin_m;  // add to the town's coordinates to get those of the map; (0, 0): as the town's file says
};

// Gives the town its origin and reference system. A system that only the file names and that nothing can be made of is
// dropped with a warning: unknown ones, degrees, coordinates near zero. `scale`: metres per unit of the town.
// Errors: a system asked for that is not known or has no metres, coordinates outside of the area that it is for, an
// origin other than the file's own.
Error SetGeoreference(const Georeference& wish, double scale, Scene* town, std::vector<std::string>* warnings);

// Where longitudes and latitudes go: "obstacles_wgs84.geojson" beside "obstacles.geojson".
std::filesystem::path LongitudeLatitudePath(const std::filesystem::path& local);

}  // namespace flaneur
