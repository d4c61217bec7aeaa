// Pictures in the blocks of 4 x 4 texels that telephones and small boards read, who read no BC (Khronos Data Format
// Specification, ETC2 and EAC). Internal to runtime/render.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace flaneur {

// channels: 1 (R11 EAC, 8 bytes a block), 2 (RG11 EAC, 16 bytes) or 4 (RGBA8 ETC2 EAC, 16 bytes), so many bytes a
// texel. Rows from the top, of blocks and of texels; edge texels fill up the last blocks.
std::vector<uint8_t> Etc2Blocks(int channels, int width_px, int height_px, std::span<const uint8_t> texels);

}  // namespace flaneur
