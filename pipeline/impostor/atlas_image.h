// Pictures of 8 bits a channel.
#pragma once
#include "pipeline/core/mesh.h"
#include "runtime/base/error.h"
#include "runtime/base/pixels.h"

namespace flaneur {

// Share of the texels with any coverage.
double FillRate(const Pixels& albedo);

// A quarter of the pixels, averaged in linear light as graphics cards' mip levels are. Sizes of at least 2 in both
// directions.
Pixels Halved(const Pixels& from);

// Straight alpha. Errors: what OpenImageIO says.
Error EncodePng(const Pixels& pixels, bool srgb, Image* image);

}  // namespace flaneur
