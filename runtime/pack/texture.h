// Block-compressed pictures, as KTX2 files hold them and graphics cards read them.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace flaneur {

// Vulkan's numbers, which KTX2 uses: one channel, two channels, four channels, colour with alpha in sRGB.
enum class TextureFormat : uint32_t { kBc4 = 139, kBc5 = 141, kBc7 = 145, kBc7Srgb = 146 };

// Levels from the largest on, each half the size before, rounded down, at least 1 px. A level is rows of 4 x 4 blocks,
// top row first.
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

// BC7 of a tour pack uses four of its eight modes: 5 (colour and alpha each by two bits a texel), 6 (all channels
// together by four), and, with the texels shared out between two pairs of ends, 1 (colour by three bits) and 7 (all
// channels by two). A texel is the first end's value plus weight / 64 of the way to the second's.
inline constexpr std::array<int, 4> kBc7TwoBitWeights{0, 21, 43, 64};
inline constexpr std::array<int, 8> kBc7ThreeBitWeights{0, 9, 18, 27, 37, 46, 55, 64};
inline constexpr std::array<int, 16> kBc7FourBitWeights{0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};

// Which texels belong to the second pair of ends, the first texel in the lowest bit (Khronos Data Format Specification,
// BPTC).
inline constexpr std::array<uint16_t, 64> kBc7Partitions{
    0xCCCC, 0x8888, 0xEEEE, 0xECC8, 0xC880, 0xFEEC, 0xFEC8, 0xEC80, 0xC800, 0xFFEC, 0xFE80, 0xE800, 0xFFE8,
    0xFF00, 0xFFF0, 0xF000, 0xF710, 0x008E, 0x7100, 0x08CE, 0x008C, 0x7310, 0x3100, 0x8CCE, 0x088C, 0x3110,
    0x6666, 0x366C, 0x17E8, 0x0FF0, 0x718E, 0x399C, 0xAAAA, 0xF0F0, 0x5A5A, 0x33CC, 0x3C3C, 0x55AA, 0x9696,
    0xA55A, 0x73CE, 0x13C8, 0x324C, 0x3BDC, 0x6996, 0xC33C, 0x9966, 0x0660, 0x0272, 0x04E4, 0x4E40, 0x2720,
    0xC936, 0x936C, 0x39C6, 0x639C, 0x9336, 0x9CC6, 0x817E, 0xE718, 0xCCF0, 0x0FCC, 0x7744, 0xEE22};
// The texel of the second pair whose index is written with one bit less; of the first pair it is texel 0.
inline constexpr std::array<uint8_t, 64> kBc7Anchors{15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15,
                                                     15, 2,  8,  2,  2,  8,  8,  15, 2,  8,  2,  2,  8,  8,  2,  2,
                                                     15, 15, 6,  8,  2,  8,  15, 15, 2,  8,  2,  2,  2,  15, 15, 6,
                                                     6,  2,  6,  8,  15, 15, 2,  2,  15, 15, 15, 15, 15, 2,  2,  15};

// Rows from the top, Channels(format) bytes a texel; for machines whose OpenGL cannot read the blocks, or reads them
// slowly. `blocks` must be as long as LevelBytes says. A BC7 block of another mode comes out transparent.
std::vector<uint8_t> DecodeLevel(TextureFormat format, int width_px, int height_px, const std::vector<uint8_t>& blocks);

}  // namespace flaneur
