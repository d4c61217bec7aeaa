// The town as a plan: SVG.
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
  const GroundRaster* ground = nullptr;      // drawn below, where given
  std::vector<Finding> findings;             // marked and listed
};

// North is up; hovering shows names. Errors: as for WriteFile.
Error WriteMap(const std::filesystem::path& path, const Footprints& footprints, const MapOptions& options);

}  // namespace flaneur
