// UASTC, one of the two codes of Basis Universal: blocks of 4 x 4 texels in 16 bytes, a part of ASTC laid out anew.
// After the "UASTC LDR 4x4 Texture Specification" and the chapter on ASTC of the Khronos Data Format Specification.
#pragma once
#include <array>
#include <cstdint>
#include <span>

namespace flaneur {

inline constexpr size_t kUastcBlock_bytes = 16;

// RGBA, row by row. False where the block is of no known mode.
bool DecodeUastcBlock(std::span<const uint8_t, kUastcBlock_bytes> block, std::array<uint8_t, 64>* rgba);

}  // namespace flaneur
