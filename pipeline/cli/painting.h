// A picture painted over the town's plan: red where people start and go to, green where they stand about.
#pragma once
#include <filesystem>
#include <optional>

#include "pipeline/core/footprint.h"
#include "runtime/base/error.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {

struct PaintingSettings {
  std::filesystem::path file;        // empty: none
  std::optional<Vec2> min_m, max_m;  // what it covers; default: what the ground does
};

// How much redder or greener a pixel is than grey counts, times its opacity: grey pixels, as of the plan itself, say
// nothing. The picture's top is north. Errors: unreadable, no red and no green, shaped otherwise than its area, no
// paint on any ground.
Error ReadPainting(const PaintingSettings& settings, const GroundRaster& ground, Painting* painting);

// The town from above in shades of grey, a pixel for each cell of the ground, to paint on: dark where something stands,
// white off the ground. A PNG file.
Error WritePlan(const std::filesystem::path& path, const GroundRaster& ground, const Footprints& footprints);

}  // namespace flaneur
