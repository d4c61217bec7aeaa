// Block-compressed pictures, as KTX2 files hold them and graphics cards read them.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace flaneur {

// Vulkan's numbers, which KTX2 uses: one channel, two channels, colour with alpha in sRGB.
enum class TextureFormat : uint32_t { kBc4 = 139, kBc5 = 141, kBc7Srgb = 146 };

// Levels from the largest on, each half the size before, rounded down, at least 1 px. A level is rows of 4 x 4 blocks, top row
// first.
struct PackTexture {
  TextureFormat format = TextureFormat::kBc7Srgb;
  int width_px = 0, height_px = 0;
  std::vector<std::vector<uint8_t>> levels;
};

constexpr size_t BlockBytes(TextureFormat format) { return format == TextureFormat::kBc4 ? 8 : 16; }
constexpr int Channels(TextureFormat format) {
  return format == TextureFormat::kBc4 ? 1 : format == TextureFormat::kBc5 ? 2 : 4;
}
constexpr size_t LevelBytes(TextureFormat format, int width_px, int height_px) {
  return static_cast<size_t>((width_px + 3) / 4) * static_cast<size_t>((height_px + 3) / 4) * BlockBytes(format);
}
inline size_t TextureBytes(const PackTexture& texture) {
  size_t bytes = 0;
  for (const auto& level : texture.levels) bytes += level.size();
  return bytes;
}

// BC7 of a tour pack uses two of its eight modes: 5 (colour and alpha each by two bits a texel) and 6 (all channels together by
// four). A texel is the first end's value plus weight / 64 of the way to the second's.
inline constexpr std::array<int, 4> kBc7TwoBitWeights{0, 21, 43, 64};
inline constexpr std::array<int, 16> kBc7FourBitWeights{0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};

// Rows from the top, Channels(format) bytes a texel; for machines whose OpenGL cannot read the blocks, or reads them slowly.
// `blocks` must be as long as LevelBytes says. A BC7 block of another mode comes out transparent.
std::vector<uint8_t> DecodeLevel(TextureFormat format, int width_px, int height_px, const std::vector<uint8_t>& blocks);

}  // namespace flaneur
