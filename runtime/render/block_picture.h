// Pictures in blocks of 4 x 4 texels that software looks up as fast as texels, in an eighth of the memory. Internal to
// runtime/render; no OpenGL.
#pragma once
#include <cstdint>
#include <vector>

#include "runtime/pack/tour_pack.h"

namespace flaneur {

// BC1 (also called DXT1): 8 bytes a block, rows of blocks, top row first. Opaque: alpha is not kept. Edge texels fill
// up the last blocks.
std::vector<uint8_t> Bc1Blocks(const PackImage& image);

}  // namespace flaneur
