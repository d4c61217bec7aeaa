#include "runtime/pack/texture.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "runtime/base/array.h"

namespace flaneur {
namespace {

using Texels = std::array<std::array<uint8_t, 4>, 16>;

// Bits of a block from the lowest on.
class BitReader {
 public:
  // count: of bytes, 16 at most.
  BitReader(const uint8_t* bytes, size_t count) {
    std::array<uint64_t, 2> halves{};
    std::memcpy(halves.data(), bytes, count);
    low_ = halves[0], high_ = halves[1];
  }
  // count: 1 to 8.
  int Next(int count) {
    const int value = static_cast<int>(low_ & ((uint64_t{1} << count) - 1));
    low_ = low_ >> count | high_ << (64 - count);
    high_ >>= count;
    return value;
  }

 private:
  uint64_t low_ = 0, high_ = 0;
};

uint8_t Between(int a, int b, int weight) { return static_cast<uint8_t>(((64 - weight) * a + weight * b + 32) >> 6); }

void DecodeMode6(BitReader bits, Texels* out) {
  int ends[4][2];
  for (auto& channel : ends) {
    for (int& end : channel) end = bits.Next(7) << 1;
  }
  const int last[2] = {bits.Next(1), bits.Next(1)};
  for (size_t i = 0; i < 16; ++i) {
    const int weight = At(kBc7FourBitWeights, bits.Next(i == 0 ? 3 : 4));
    for (size_t c = 0; c < 4; ++c) (*out)[i][c] = Between(ends[c][0] | last[0], ends[c][1] | last[1], weight);
  }
}

void DecodeMode5(BitReader bits, Texels* out) {
  const auto rotation = static_cast<size_t>(bits.Next(2));
  int ends[4][2];
  for (size_t c = 0; c < 4; ++c) {
    for (int& end : ends[c]) {
      end = bits.Next(c < 3 ? 7 : 8);
      if (c < 3) end = end << 1 | end >> 6;
    }
  }
  for (size_t i = 0; i < 16; ++i) {
    const int weight = At(kBc7TwoBitWeights, bits.Next(i == 0 ? 1 : 2));
    for (size_t c = 0; c < 3; ++c) (*out)[i][c] = Between(ends[c][0], ends[c][1], weight);
  }
  for (size_t i = 0; i < 16; ++i) {
    const int weight = At(kBc7TwoBitWeights, bits.Next(i == 0 ? 1 : 2));
    (*out)[i][3] = Between(ends[3][0], ends[3][1], weight);
    if (rotation > 0) std::swap((*out)[i][3], (*out)[i][rotation - 1]);
  }
}

// Modes 1 and 7: two pairs of ends. An end has `bits` bits and a last one: of the pair or of its own.
void DecodePairs(BitReader bits, bool with_alpha, Texels* out) {
  const auto partition = static_cast<size_t>(bits.Next(6));
  const size_t channels = with_alpha ? 4 : 3;
  const int width = with_alpha ? 5 : 6;
  int ends[4][4];
  for (size_t c = 0; c < channels; ++c) {
    for (int& end : ends[c]) end = bits.Next(width) << 1;
  }
  int last[4];
  for (size_t e = 0; e < 4; ++e) last[e] = with_alpha || e % 2 == 0 ? bits.Next(1) : last[e - 1];
  for (size_t c = 0; c < channels; ++c) {
    for (size_t e = 0; e < 4; ++e) {
      const int value = ends[c][e] | last[e];
      ends[c][e] = value << (7 - width) | value >> (2 * width - 6);
    }
  }
  for (size_t i = 0; i < 16; ++i) {
    const size_t pair = kBc7Partitions[partition] >> i & 1u;
    const int less = i == 0 || i == kBc7Anchors[partition] ? 1 : 0;
    const int weight =
        with_alpha ? At(kBc7TwoBitWeights, bits.Next(2 - less)) : At(kBc7ThreeBitWeights, bits.Next(3 - less));
    (*out)[i][3] = 255;
    for (size_t c = 0; c < channels; ++c) (*out)[i][c] = Between(ends[c][2 * pair], ends[c][2 * pair + 1], weight);
  }
}

void DecodeBc7(const uint8_t* block, Texels* out) {
  *out = {};
  BitReader bits(block, 16);
  int mode = 0;
  while (mode < 8 && bits.Next(1) == 0) ++mode;
  if (mode == 1 || mode == 7) DecodePairs(bits, mode == 7, out);
  if (mode == 6) DecodeMode6(bits, out);
  if (mode == 5) DecodeMode5(bits, out);
}

void DecodeBc4(const uint8_t* block, size_t channel, Texels* out) {
  const int a = block[0], b = block[1];
  std::array<int, 8> values{a, b};
  const int steps = a > b ? 7 : 5;
  for (int i = 1; i < steps; ++i) At(values, i + 1) = ((steps - i) * a + i * b + steps / 2) / steps;
  if (steps == 5) values[6] = 0, values[7] = 255;
  BitReader bits(block + 2, 6);
  for (auto& texel : *out) texel[channel] = static_cast<uint8_t>(At(values, bits.Next(3)));
}

void DecodeBlock(TextureFormat format, const uint8_t* block, Texels* out) {
  if (format == TextureFormat::kBc7 || format == TextureFormat::kBc7Srgb) return DecodeBc7(block, out);
  DecodeBc4(block, 0, out);
  if (format == TextureFormat::kBc5) DecodeBc4(block + 8, 1, out);
}

template <size_t kChannels>
void DecodeBlocks(TextureFormat format, size_t width, size_t height, const uint8_t* block, uint8_t* out) {
  Texels texels{};
  for (size_t top = 0; top < height; top += 4) {
    const size_t rows = std::min<size_t>(4, height - top);
    for (size_t left = 0; left < width; left += 4, block += BlockBytes(format)) {
      DecodeBlock(format, block, &texels);
      const size_t columns = std::min<size_t>(4, width - left);
      for (size_t y = 0; y < rows; ++y) {
        uint8_t* to = out + ((top + y) * width + left) * kChannels;
        for (size_t x = 0; x < columns; ++x) std::copy_n(texels[4 * y + x].begin(), kChannels, to + x * kChannels);
      }
    }
  }
}

}  // namespace

std::vector<uint8_t> DecodeLevel(TextureFormat format, int width_px, int height_px,
                                 const std::vector<uint8_t>& blocks) {
  const auto channels = static_cast<size_t>(Channels(format));
  const auto width = static_cast<size_t>(width_px), height = static_cast<size_t>(height_px);
  std::vector<uint8_t> out(width * height * channels);
  const auto decode = channels == 4 ? DecodeBlocks<4> : channels == 2 ? DecodeBlocks<2> : DecodeBlocks<1>;
  decode(format, width, height, blocks.data(), out.data());
  return out;
}

}  // namespace flaneur
