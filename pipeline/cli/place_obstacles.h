// Obstacles where their town stands, whatever their file says.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/footprint/check.h"
#include "pipeline/io/geojson.h"

namespace flaneur {

// Brings the obstacles of `path`, read with `reading` into `file`, into the town's coordinates. Where they do not fit
// the town as the file has it, other readings are tried: shifted as a whole, axes swapped, in the town's own system.
// The first that fits is taken and told in a fault (kElsewhere), unless the file has one already. `found` is false
// where they cannot be brought into the town's coordinates at all. Errors: none but PROJ's own.
Error PlaceObstacles(const std::filesystem::path& path, const ReadGeoJsonOptions& reading, const PreparedTown& town,
                     double tolerance_m, GeoJsonFile* file, bool* found, std::vector<std::string>* warnings);

}  // namespace flaneur
