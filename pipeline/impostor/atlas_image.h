// Pictures of 8 bits a channel.
#pragma once
#include <cstdint>
#include <vector>

#include "pipeline/core/mesh.h"
#include "runtime/base/error.h"

namespace flaneur {

// 8-bit RGBA, rows from the top.
struct Pixels {
  int width = 0, height = 0;
  std::vector<uint8_t> rgba;
};

// Share of the texels with any coverage.
double FillRate(const Pixels& albedo);

// Straight alpha. Errors: what OpenImageIO says.
Error EncodePng(const Pixels& pixels, bool srgb, Image* image);

}  // namespace flaneur
