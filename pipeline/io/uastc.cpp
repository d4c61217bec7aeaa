#include "pipeline/io/uastc.h"

#include <algorithm>

#include "pipeline/io/bits.h"

namespace flaneur {
namespace {

struct Mode {
  uint32_t code;  // which a block begins with
  int code_bits, hint_bits;
  int weight_bits;
  int endpoint_bits, endpoint_base;  // an endpoint is a digit of that base (1: none) above so many bits
  int subsets, planes, channels;     // of two channels: grey and alpha
};

constexpr int kSolid = 8;  // the mode of one colour
constexpr std::array<Mode, 19> kModes{{
    {0x01, 4, 15, 4, 6, 3, 1, 1, 3}, {0x35, 6, 15, 2, 8, 1, 1, 1, 3}, {0x1D, 5, 15, 3, 4, 1, 2, 1, 3},
    {0x03, 5, 15, 2, 2, 3, 3, 1, 3}, {0x13, 5, 15, 2, 3, 5, 2, 1, 3}, {0x0B, 5, 15, 3, 8, 1, 1, 1, 3},
    {0x1B, 5, 15, 2, 5, 5, 1, 2, 3}, {0x07, 5, 15, 2, 3, 5, 2, 1, 3}, {0x17, 5, 0, 0, 8, 1, 1, 1, 4},
    {0x0F, 5, 23, 2, 4, 1, 2, 1, 4}, {0x02, 3, 17, 4, 4, 3, 1, 1, 4}, {0x00, 2, 17, 2, 4, 3, 1, 2, 4},
    {0x06, 3, 17, 3, 6, 3, 1, 1, 4}, {0x1F, 5, 23, 1, 8, 1, 1, 2, 4}, {0x0D, 5, 23, 2, 8, 1, 1, 1, 4},
    {0x05, 7, 23, 4, 8, 1, 1, 1, 2}, {0x15, 6, 23, 2, 8, 1, 2, 1, 2}, {0x25, 6, 23, 2, 8, 1, 1, 2, 2},
    {0x09, 4, 15, 5, 5, 1, 1, 1, 3},
}};

// Which texels are of the second subset, and of the third; bit 4 y + x.
using Pattern = std::array<uint16_t, 2>;
constexpr std::array<Pattern, 30> kHalves{
    {{0xCCCC}, {0x8888}, {0x1111}, {0xECC8}, {0x377F}, {0xFEEC}, {0x0137}, {0x137F}, {0xC800}, {0x0013},
     {0xFE80}, {0x17FF}, {0x0017}, {0x00FF}, {0xFFF0}, {0x0FFF}, {0xFF71}, {0x8EFF}, {0x08CE}, {0x008C},
     {0x7310}, {0xCEFF}, {0x7331}, {0x088C}, {0xCEEF}, {0x6666}, {0xF00F}, {0x5555}, {0x0F0F}, {0x36C9}}};
constexpr std::array<Pattern, 19> kHalvesOfMode7{{{0x00F0},
                                                  {0x4444},
                                                  {0x0133},
                                                  {0xCC80},
                                                  {0xF0FF},
                                                  {0x2222},
                                                  {0xFFC8},
                                                  {0xCCCE},
                                                  {0x3C03},
                                                  {0x00EE},
                                                  {0x7700},
                                                  {0x3003},
                                                  {0x00CE},
                                                  {0xFF80},
                                                  {0x6FFF},
                                                  {0x1333},
                                                  {0x11FF},
                                                  {0x136C},
                                                  {0x00EF}}};
constexpr std::array<Pattern, 11> kThirds{{{0x3300, 0xCC00},
                                           {0x00FF, 0xF000},
                                           {0x000F, 0xF000},
                                           {0x000F, 0x00F0},
                                           {0x3333, 0x4444},
                                           {0x6666, 0x8888},
                                           {0xCCCC, 0x2222},
                                           {0xEE00, 0x1111},
                                           {0x4444, 0x9999},
                                           {0xF00F, 0x0F00},
                                           {0x0CC0, 0xC00C}}};

int SubsetOf(const Pattern& pattern, int texel) {
  return (pattern[0] >> texel & 1) != 0 ? 1 : (pattern[1] >> texel & 1) != 0 ? 2 : 0;
}

bool ReadPattern(size_t mode, BitReader* bits, Pattern* pattern) {
  const uint32_t index = kModes[mode].subsets > 1 ? bits->Take(kModes[mode].subsets == 3 ? 4 : 5) : 0;
  const std::span<const Pattern> all = kModes[mode].subsets == 3 ? std::span<const Pattern>(kThirds)
                                       : mode == 7               ? std::span<const Pattern>(kHalvesOfMode7)
                                                                 : std::span<const Pattern>(kHalves);
  if (index >= all.size()) return false;
  *pattern = kModes[mode].subsets > 1 ? all[index] : Pattern{};
  return true;
}

// ASTC's endpoint of 8 bits: the bits spread over all of them, and the digit's share.
int Unquantized(uint32_t bits, uint32_t digit, int bit_count, int base) {
  if (base == 1)
    return static_cast<int>(bit_count == 4 ? bits << 4 | bits : bit_count == 5 ? bits << 3 | bits >> 2 : bits);
  const uint32_t high = bits >> 1;  // all but the least, which mirrors the scale
  uint32_t spread = 0, step = 0;
  if (base == 3 && bit_count == 2) spread = high * 0x116, step = 93;
  if (base == 3 && bit_count == 4) spread = high << 6 | high, step = 22;
  if (base == 3 && bit_count == 6) spread = high << 4 | high >> 4, step = 5;
  if (base == 5 && bit_count == 3) spread = high << 7 | high << 1 | high >> 1, step = 26;
  if (base == 5 && bit_count == 5) spread = high << 5 | high >> 3, step = 6;
  const uint32_t mirror = (bits & 1) != 0 ? 0x1FF : 0;
  const uint32_t value = (digit * step + spread) ^ mirror;
  return static_cast<int>((mirror & 0x80) | value >> 2);
}

// Digits stand before all bits, five of three or three of five in one number.
std::array<int, 18> ReadEndpoints(const Mode& mode, BitReader* bits) {
  const int count = 2 * mode.channels * mode.subsets;
  std::array<uint32_t, 20> digits{};
  const int together = mode.endpoint_base == 3 ? 5 : 3;
  for (int first = 0; mode.endpoint_base > 1 && first < count; first += together) {
    static constexpr std::array<int, 6> kBitsOfTrits{0, 2, 4, 5, 7, 8}, kBitsOfQuints{0, 3, 5, 7, 0, 0};
    const size_t here = static_cast<size_t>(std::min(together, count - first));
    uint32_t number = bits->Take((mode.endpoint_base == 3 ? kBitsOfTrits : kBitsOfQuints)[here]);
    for (size_t i = 0; i < here; ++i, number /= static_cast<uint32_t>(mode.endpoint_base))
      digits[static_cast<size_t>(first) + i] = number % static_cast<uint32_t>(mode.endpoint_base);
  }
  std::array<int, 18> endpoints{};
  for (size_t i = 0; i < static_cast<size_t>(count); ++i)
    endpoints[i] = Unquantized(bits->Take(mode.endpoint_bits), digits[i], mode.endpoint_bits, mode.endpoint_base);
  return endpoints;
}

// Of 64.
int UnquantizedWeight(uint32_t weight, int bits) {
  uint32_t six = 0;
  for (int shift = 6 - bits; shift > -bits; shift -= bits) six |= shift >= 0 ? weight << shift : weight >> -shift;
  return static_cast<int>(six + (six > 32 ? 1 : 0));
}

// The first weight of each subset lacks its highest bit, which is 0.
std::array<int, 32> ReadWeights(const Mode& mode, const Pattern& pattern, BitReader* bits) {
  std::array<int, 32> weights{};
  std::array<bool, 3> begun{};
  for (int texel = 0; texel < 16; ++texel) {
    bool& known = begun[static_cast<size_t>(SubsetOf(pattern, texel))];
    for (int plane = 0; plane < mode.planes; ++plane) {
      const uint32_t weight = bits->Take(mode.weight_bits - (known ? 0 : 1));
      weights[static_cast<size_t>(2 * texel + plane)] = UnquantizedWeight(weight, mode.weight_bits);
    }
    known = true;
  }
  return weights;
}

uint8_t Between(int low, int high, int weight) {
  low |= low << 8, high |= high << 8;
  return static_cast<uint8_t>((low * (64 - weight) + high * weight + 32) >> 6 >> 8);
}

// Two channels are grey and alpha, three are opaque.
int EndpointOf(const Mode& mode, int channel) {
  if (mode.channels == 2) return channel < 3 ? 0 : 1;
  return channel < mode.channels ? channel : -1;
}

}  // namespace

bool DecodeUastcBlock(std::span<const uint8_t, kUastcBlock_bytes> block, std::array<uint8_t, 64>* rgba) {
  size_t m = 0;
  while (m < kModes.size() && (block[0] & ((1u << kModes[m].code_bits) - 1)) != kModes[m].code) ++m;
  if (m == kModes.size()) return false;
  const Mode& mode = kModes[m];
  BitReader bits{block, static_cast<size_t>(mode.code_bits)};
  if (m == kSolid) {
    for (size_t c = 0; c < 4; ++c) (*rgba)[c] = static_cast<uint8_t>(bits.Take(8));
    for (size_t i = 4; i < rgba->size(); ++i) (*rgba)[i] = (*rgba)[i - 4];
    return true;
  }
  bits.at += static_cast<size_t>(mode.hint_bits);
  Pattern pattern{};
  if (!ReadPattern(m, &bits, &pattern)) return false;
  // The channel that the second plane is of.
  const int apart = mode.planes == 1 ? -1 : mode.channels == 2 ? 3 : static_cast<int>(bits.Take(2));
  const std::array<int, 18> endpoints = ReadEndpoints(mode, &bits);
  const std::array<int, 32> weights = ReadWeights(mode, pattern, &bits);
  for (int i = 0; i < 64; ++i) {
    const int texel = i / 4, channel = i % 4, of = EndpointOf(mode, channel);
    const size_t pair = static_cast<size_t>(2 * (mode.channels * SubsetOf(pattern, texel) + of));
    const int weight = weights[static_cast<size_t>(2 * texel + (channel == apart ? 1 : 0))];
    (*rgba)[static_cast<size_t>(i)] = of < 0 ? uint8_t{255} : Between(endpoints[pair], endpoints[pair + 1], weight);
  }
  return true;
}

}  // namespace flaneur
