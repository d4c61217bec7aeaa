// Pictures of 8 bits a channel.
#pragma once
#include "runtime/base/pixels.h"

namespace flaneur {

// Share of the texels with any coverage.
double FillRate(const Pixels& albedo);

// A quarter of the pixels, averaged in linear light as graphics cards' mip levels are. Sizes of at least 2 in both
// directions.
Pixels Halved(const Pixels& from);

}  // namespace flaneur
