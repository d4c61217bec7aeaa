// The town as a plan: a picture (SVG), and a page that zooms (HTML).
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/core/footprint.h"
#include "pipeline/footprint/findings.h"
#include "runtime/base/error.h"

namespace flaneur {

struct MapOptions {
  std::string title;
  const GroundRaster* ground = nullptr;           // drawn below, where given
  std::vector<Finding> findings;                  // marked and listed
  std::vector<std::vector<Point2>> streets = {};  // their middle lines
  std::vector<Point2> stops = {};                 // of the guided tour, in order: a numbered line
};

// North is up; hovering shows names. Errors: as for WriteFile.
Error WriteMap(const std::filesystem::path& path, const Footprints& footprints, const MapOptions& options);

// One file without anything from elsewhere: wheel and drag zoom and move, the list leads to each finding and back.
Error WriteMapPage(const std::filesystem::path& path, const Footprints& footprints, const MapOptions& options);

}  // namespace flaneur
