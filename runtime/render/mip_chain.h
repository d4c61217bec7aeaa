// Smaller copies of a picture for distant surfaces. Made on all cores while a pack is uploaded, because drivers without
// a GPU take seconds for it. Internal to runtime/render; no OpenGL.
#pragma once
#include <cstdint>
#include <vector>

#include "runtime/pack/tour_pack.h"

namespace flaneur {

// Levels 1, 2, ... of the picture (each half the size before, rounded down, at least 1 px), as RGBA bytes: until 1 x 1
// or `most_level`. With `srgb` colours are averaged as light.
std::vector<PackImage> MakeMipChain(const PackImage& image, bool srgb, int most_level);

}  // namespace flaneur
