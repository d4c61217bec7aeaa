#include "runtime/render/etc2_blocks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace flaneur {
namespace {

// The first half of each table; the second is -1 less each of these.
constexpr std::array<std::array<int8_t, 4>, 16> kChannelTables{{{-3, -6, -9, -15},
                                                                {-3, -7, -10, -13},
                                                                {-2, -5, -8, -13},
                                                                {-2, -4, -6, -13},
                                                                {-3, -6, -8, -12},
                                                                {-3, -7, -9, -11},
                                                                {-4, -7, -8, -11},
                                                                {-3, -5, -8, -11},
                                                                {-2, -6, -8, -10},
                                                                {-2, -5, -8, -10},
                                                                {-2, -4, -8, -10},
                                                                {-2, -5, -7, -10},
                                                                {-3, -4, -7, -10},
                                                                {-1, -2, -3, -10},
                                                                {-4, -6, -8, -9},
                                                                {-3, -5, -7, -9}}};
// Steps of brightness, the other two of each table are the negative ones.
constexpr std::array<std::array<int, 2>, 8> kColorTables{
    {{2, 8}, {5, 17}, {9, 29}, {13, 42}, {18, 60}, {24, 80}, {33, 106}, {47, 183}}};

// Texels as blocks count them: down the columns, from the left.
using Channel = std::array<float, 16>;
using Color = std::array<int, 3>;
using Colors = std::array<Color, 16>;

void Write(uint64_t bits, uint8_t* to) {
  for (int byte = 0; byte < 8; ++byte) to[byte] = static_cast<uint8_t>(bits >> (56 - 8 * byte));
}

int Step(const std::array<int8_t, 4>& table, size_t index) { return index < 4 ? table[index] : -1 - table[index - 4]; }

struct ChannelFit {
  uint64_t bits = 0;
  float error = std::numeric_limits<float>::max();
};

// Of values between low and high, each base + a step of the table * times.
ChannelFit FitChannel(const Channel& values, float low, float high, size_t table_index) {
  const std::array<int8_t, 4>& table = kChannelTables[table_index];
  const auto most = static_cast<float>(-1 - table[3]), least = static_cast<float>(table[3]);
  const float times = std::clamp(std::ceil((high - low) / (most - least)), 1.0f, 15.0f);
  const float base = std::clamp(std::round((low + high - times * (most + least)) / 2), 0.0f, 255.0f);
  ChannelFit fit{static_cast<uint64_t>(base) << 56 | static_cast<uint64_t>(times) << 52 | uint64_t{table_index} << 48,
                 0};
  for (size_t i = 0; i < values.size(); ++i) {
    float nearest = std::numeric_limits<float>::max();
    uint64_t chosen = 0;
    for (size_t k = 0; k < 8; ++k) {
      const float off = base + times * static_cast<float>(Step(table, k)) - values[i];
      if (off * off < nearest) nearest = off * off, chosen = k;
    }
    fit.error += nearest;
    fit.bits |= chosen << (45 - 3 * i);
  }
  return fit;
}

void WriteChannel(const Channel& values, uint8_t* to) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  ChannelFit best;
  for (size_t table = kChannelTables.size(); table-- > 0 && best.error > 0.1f;) {
    const ChannelFit fit = FitChannel(values, *low, *high, table);
    if (fit.error < best.error) best = fit;
  }
  Write(best.bits, to);
}

int Squared(int off) { return off * off; }

struct HalfFit {
  uint32_t table = 0, indices = 0;
  int error = std::numeric_limits<int>::max();
};

int Brighter(const HalfFit& fit, size_t texel) {
  const int step = kColorTables[fit.table][fit.indices >> texel & 1];
  return fit.indices >> (16 + texel) & 1 ? -step : step;
}

// Eight texels of which each is the base, brighter or darker by a step of a table.
HalfFit FitHalf(const Colors& colors, const std::array<size_t, 8>& texels, const Color& base) {
  std::array<int, 8> brighter;  // summed over the channels
  for (size_t i = 0; i < 8; ++i) {
    const Color& c = colors[texels[i]];
    brighter[i] = c[0] - base[0] + c[1] - base[1] + c[2] - base[2];
  }
  HalfFit best;
  for (uint32_t t = 0; t < kColorTables.size(); ++t) {
    const auto [small, large] = kColorTables[t];
    HalfFit fit{t, 0, 0};
    for (size_t i = 0; i < 8; ++i) {
      const int size = std::abs(brighter[i]);
      const bool takes_large = 2 * size > 3 * (small + large), darker = brighter[i] < 0;
      fit.error += Squared(size - 3 * (takes_large ? large : small));
      fit.indices |= (darker ? 1u << (16 + texels[i]) : 0) | (takes_large ? 1u << texels[i] : 0);
    }
    if (fit.error < best.error) best = fit;
  }
  best.error = 0;
  for (size_t texel : texels) {
    for (size_t c = 0; c < 3; ++c)
      best.error += Squared(std::clamp(base[c] + Brighter(best, texel), 0, 255) - colors[texel][c]);
  }
  return best;
}

Color Mean(const Colors& colors, const std::array<size_t, 8>& texels) {
  Color sum{4, 4, 4};
  for (size_t texel : texels) {
    for (size_t c = 0; c < 3; ++c) sum[c] += colors[texel][c];
  }
  return {sum[0] / 8, sum[1] / 8, sum[2] / 8};
}

// `value` as the `width` bits of the block that end with bit `low`.
uint64_t At(int value, int width, int low) {
  return (static_cast<uint64_t>(value) & ((uint64_t{1} << width) - 1)) << low;
}

struct ColorFit {
  uint64_t bits = 0;
  int error = std::numeric_limits<int>::max();
};

// Two halves with a base each. flip: they lie one upon the other.
ColorFit FitHalves(const Colors& colors, bool flip) {
  std::array<std::array<size_t, 8>, 2> halves;
  for (size_t i = 0; i < 8; ++i) {
    const size_t first = flip ? i / 2 * 4 + i % 2 : i;
    halves[0][i] = first;
    halves[1][i] = first + (flip ? 2 : 8);
  }
  const std::array<Color, 2> means{Mean(colors, halves[0]), Mean(colors, halves[1])};
  std::array<Color, 2> fine, bases;  // of five bits a channel
  bool near = true;
  for (size_t c = 0; c < 3; ++c) {
    for (size_t h = 0; h < 2; ++h) fine[h][c] = (means[h][c] * 31 + 127) / 255;
    const int further = fine[1][c] - fine[0][c];
    near = near && further >= -4 && further <= 3;
  }
  uint64_t bits = At(near ? 1 : 0, 1, 33) | At(flip ? 1 : 0, 1, 32);
  for (size_t c = 0; c < 3; ++c) {
    const int low = 56 - 8 * static_cast<int>(c);
    const std::array<int, 2> coarse{(means[0][c] * 15 + 127) / 255, (means[1][c] * 15 + 127) / 255};
    bits |= near ? At(fine[0][c], 5, low + 3) | At(fine[1][c] - fine[0][c], 3, low)
                 : At(coarse[0], 4, low + 4) | At(coarse[1], 4, low);
    for (size_t h = 0; h < 2; ++h) bases[h][c] = near ? fine[h][c] << 3 | fine[h][c] >> 2 : coarse[h] * 17;
  }
  const HalfFit one = FitHalf(colors, halves[0], bases[0]), other = FitHalf(colors, halves[1], bases[1]);
  bits |= uint64_t{one.table} << 37 | uint64_t{other.table} << 34 | one.indices | other.indices;
  return {bits, one.error + other.error};
}

// A channel that rises evenly to the right and downwards.
struct Plane {
  int origin = 0, right = 0, down = 0;  // as stored: at the first texel, and four further
};

Plane FitPlane(const Colors& colors, size_t channel, int width, int* error) {
  float sum = 0, rightwards = 0, downwards = 0;
  for (size_t i = 0; i < 16; ++i) {
    const auto value = static_cast<float>(colors[i][channel]);
    sum += value;
    rightwards += value * (static_cast<float>(i / 4) - 1.5f) / 20;
    downwards += value * (static_cast<float>(i % 4) - 1.5f) / 20;
  }
  const float origin = sum / 16 - 1.5f * (rightwards + downwards), most = static_cast<float>((1 << width) - 1);
  const auto stored = [&](float value) {
    return static_cast<int>(std::lround(std::clamp(value, 0.0f, 255.0f) * most / 255));
  };
  const Plane plane{stored(origin), stored(origin + 4 * rightwards), stored(origin + 4 * downwards)};
  const auto whole = [&](int value) { return value << (8 - width) | value >> (2 * width - 8); };
  const int o = whole(plane.origin), r = whole(plane.right), d = whole(plane.down);
  for (int i = 0; i < 16; ++i) {
    const int value = std::clamp((i / 4 * (r - o) + i % 4 * (d - o) + 4 * o + 2) >> 2, 0, 255);
    *error += Squared(value - colors[static_cast<size_t>(i)][channel]);
  }
  return plane;
}

// Whether the channel whose two bases stand from that bit on would leave what five bits hold: so a block says that it
// is a plane.
bool Overflows(uint64_t bits, int low) {
  const int base = static_cast<int>(bits >> (low + 3) & 31), further = static_cast<int>(bits >> low & 7);
  const int other = base + (further < 4 ? further : further - 8);
  return other < 0 || other > 31;
}

ColorFit FitPlanes(const Colors& colors) {
  ColorFit fit{At(1, 1, 33), 0};
  const Plane red = FitPlane(colors, 0, 6, &fit.error), green = FitPlane(colors, 1, 7, &fit.error);
  const Plane blue = FitPlane(colors, 2, 6, &fit.error);
  fit.bits |= At(red.origin, 6, 57) | At(green.origin >> 6, 1, 56) | At(green.origin, 6, 49);
  fit.bits |= At(blue.origin >> 5, 1, 48) | At(blue.origin >> 3, 2, 43) | At(blue.origin, 3, 39);
  fit.bits |= At(red.right >> 1, 5, 34) | At(red.right, 1, 32) | At(green.right, 7, 25) | At(blue.right, 6, 19);
  fit.bits |= At(red.down, 6, 13) | At(green.down, 7, 6) | At(blue.down, 6, 0);
  if (Overflows(fit.bits, 56)) fit.bits |= At(1, 1, 63);
  if (Overflows(fit.bits, 48)) fit.bits |= At(1, 1, 55);
  for (int free = 0; free < 16 && !Overflows(fit.bits, 40); ++free) {
    fit.bits &= ~(At(7, 3, 45) | At(1, 1, 42));
    fit.bits |= At(free >> 1, 3, 45) | At(free, 1, 42);
  }
  return fit;
}

void WriteColors(const Colors& colors, uint8_t* to) {
  ColorFit best = FitPlanes(colors);
  for (bool flip : {false, true}) {
    if (best.error == 0) break;
    const ColorFit fit = FitHalves(colors, flip);
    if (fit.error < best.error) best = fit;
  }
  Write(best.bits, to);
}

// A channel of 11 bits holds 8 times what its block says, and 4 more.
float OfElevenBits(uint8_t value) { return (static_cast<float>(value) * (2047.0f / 255) - 4) / 8; }

using Block = std::array<std::array<uint8_t, 4>, 16>;

void WriteBlock(const Block& block, int channels, uint8_t* to) {
  Channel values;
  if (channels < 4) {
    for (size_t c = 0; c < static_cast<size_t>(channels); ++c) {
      for (size_t i = 0; i < 16; ++i) values[i] = OfElevenBits(block[i][c]);
      WriteChannel(values, to + 8 * c);
    }
    return;
  }
  Colors colors;
  for (size_t i = 0; i < 16; ++i) {
    values[i] = block[i][3];
    colors[i] = {block[i][0], block[i][1], block[i][2]};
  }
  WriteChannel(values, to);
  WriteColors(colors, to + 8);
}

}  // namespace

std::vector<uint8_t> Etc2Blocks(int channels, int width_px, int height_px, std::span<const uint8_t> texels) {
  const int across = (width_px + 3) / 4, up = (height_px + 3) / 4;
  const size_t block_bytes = channels == 1 ? 8 : 16;
  std::vector<uint8_t> blocks(static_cast<size_t>(across) * static_cast<size_t>(up) * block_bytes);
  uint8_t* to = blocks.data();
  for (int y = 0; y < 4 * up; y += 4) {
    for (int x = 0; x < 4 * across; x += 4, to += block_bytes) {
      Block block{};
      for (int i = 0; i < 16; ++i) {
        const int row = std::min(y + i % 4, height_px - 1), column = std::min(x + i / 4, width_px - 1);
        const auto from = static_cast<std::ptrdiff_t>((row * width_px + column) * channels);
        std::copy_n(texels.begin() + from, channels, block[static_cast<size_t>(i)].begin());
      }
      WriteBlock(block, channels, to);
    }
  }
  return blocks;
}

}  // namespace flaneur
