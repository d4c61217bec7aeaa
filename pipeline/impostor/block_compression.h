// Pictures as blocks of 4 x 4 texels that graphics cards read as they are. Internal to pipeline/impostor.
#pragma once
#include <array>
#include <cstdint>
#include <span>

namespace flaneur {

using BlockTexels = std::array<std::array<uint8_t, 4>, 16>;  // RGBA, rows from the top

// Modes 1, 5, 6 and 7, whichever comes nearest. Colours count by `weights` (0 to 1 each): those of texels that nobody
// sees may come out otherwise.
void CompressBc7(const BlockTexels& texels, const std::array<float, 16>& weights, std::span<uint8_t, 16> block);

// One channel.
void CompressBc4(const std::array<uint8_t, 16>& values, std::span<uint8_t, 8> block);

}  // namespace flaneur
