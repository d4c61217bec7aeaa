// From tour.toml to a tour pack.
#pragma once
#include <filesystem>

#include "runtime/base/error.h"

namespace flaneur {

// Writes NAME.glb, report.json, report.html and footprints.geojson into `output` (empty: build_assets/NAME under the
// current folder), keeping intermediate results in output/cache. What is there already is only replaced when all stages
// succeeded.
Error Bake(const std::filesystem::path& tour, const std::filesystem::path& output);

}  // namespace flaneur
