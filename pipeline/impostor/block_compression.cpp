#include "pipeline/impostor/block_compression.h"

#include <cstring>

#define STB_DXT_IMPLEMENTATION
#define STB_DXT_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wshadow"
#include <stb/stb_dxt.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <cmath>

#include "runtime/base/array.h"
#include "runtime/pack/texture.h"

namespace flaneur {
namespace {

using Color = std::array<float, 4>;
using Ends = std::array<std::array<int, 4>, 2>;
using Weights = std::array<float, 16>;

constexpr float kAlphaWeight = 0.5f;  // coverage is a smooth ramp, which four bits hold well
constexpr int kRefinements = 3;
constexpr double kGoodEnough = 16;  // summed squares of a block that needs no second pair of ends
constexpr size_t kTried = 3;        // partitions whose colours lie nearest to two lines

// The texels channel by channel, as processors take many at once.
using Four = float __attribute__((vector_size(16)));
using FourInts = int __attribute__((vector_size(16)));
struct Planes {
  Four fours[4][4];  // by channel
  float At(size_t channel, size_t texel) const { return fours[channel][texel / 4][texel % 4]; }
};

Planes PlanesOf(const BlockTexels& texels) {
  Planes planes{};
  for (size_t i = 0; i < 16; ++i) {
    for (size_t c = 0; c < 4; ++c) planes.fours[c][i / 4][i % 4] = static_cast<float>(texels[i][c]);
  }
  return planes;
}

// Bits of a block from the lowest on.
class BitWriter {
 public:
  explicit BitWriter(std::span<uint8_t, 16> bytes) : bytes_(bytes) {
    std::fill(bytes.begin(), bytes.end(), uint8_t{0});
  }
  void Put(int value, int count) {
    for (int i = 0; i < count; ++i, ++at_) bytes_[at_ / 8] |= static_cast<uint8_t>((value >> i & 1) << (at_ % 8));
  }

 private:
  std::span<uint8_t, 16> bytes_;
  size_t at_ = 0;
};

// Some channels of a block as one line of colours: two ends, and for each texel how far it is along.
struct Line {
  size_t first = 0, count = 4;  // channels
  std::span<const int> steps;   // weights / 64 that an index stands for
  uint32_t members = 0xFFFF;    // texels that are on it
  Ends ends{};
  std::array<int, 16> indices{};
  double error = 1e30;
};

bool IsOn(const Line& line, size_t texel) { return (line.members >> texel & 1) != 0; }

int Between(int a, int b, int weight) { return ((64 - weight) * a + weight * b + 32) >> 6; }

// Error with the best indices for these ends.
void Fit(const Planes& texels, const Weights& weights, const Ends& ends, Line* line) {
  std::array<float, 16> nearest;
  std::array<int, 16> indices;
  std::array<std::array<float, 4>, 16> palette{};
  const size_t end = line->first + line->count;
  for (size_t s = 0; s < line->steps.size(); ++s) {
    for (size_t c = line->first; c < end; ++c)
      palette[s][c] = static_cast<float>(Between(ends[0][c], ends[1][c], line->steps[s]));
  }
  for (size_t k = 0; k < 4; ++k) {
    Four least = Four{} + 1e30f, weight;
    FourInts best{};
    std::memcpy(&weight, &weights[4 * k], sizeof weight);
    for (size_t s = 0; s < line->steps.size(); ++s) {
      Four off{};
      for (size_t c = line->first; c < end; ++c) {
        const Four d = palette[s][c] - texels.fours[c][k];
        off += c == 3 ? d * d * kAlphaWeight : d * d * weight;
      }
      const FourInts nearer = off < least;
      best = nearer ? FourInts{} + static_cast<int>(s) : best;
      least = nearer ? off : least;
    }
    std::memcpy(&nearest[4 * k], &least, sizeof least);
    std::memcpy(&indices[4 * k], &best, sizeof best);
  }
  double error = 0;
  for (size_t i = 0; i < 16; ++i) error += IsOn(*line, i) ? static_cast<double>(nearest[i]) : 0.0;
  if (error >= line->error) return;
  for (size_t i = 0; i < 16; ++i) line->indices[i] = IsOn(*line, i) ? indices[i] : 0;
  line->ends = ends;
  line->error = error;
}

// The direction in which the colours differ most, by power iteration.
void PrincipalAxis(const Planes& texels, const Weights& weights, const Line& line, Color* mean, Color* axis) {
  float sum = 1e-6f;
  *mean = {};
  for (size_t i = 0; i < 16; ++i) {
    if (!IsOn(line, i)) continue;
    sum += weights[i];
    for (size_t c = 0; c < 4; ++c) (*mean)[c] += weights[i] * texels.At(c, i);
  }
  for (float& m : *mean) m /= sum;
  *axis = {1, 1, 1, 1};
  for (int round = 0; round < 6; ++round) {
    Color next{};
    for (size_t i = 0; i < 16; ++i) {
      if (!IsOn(line, i)) continue;
      float along = 0;
      for (size_t c = line.first; c < line.first + line.count; ++c)
        along += (*axis)[c] * (texels.At(c, i) - (*mean)[c]);
      for (size_t c = 0; c < 4; ++c) next[c] += weights[i] * along * (texels.At(c, i) - (*mean)[c]);
    }
    float length = 0;
    for (size_t c = line.first; c < line.first + line.count; ++c) length += next[c] * next[c];
    if (length < 1e-6f) return;
    for (float& n : next) n /= std::sqrt(length);
    *axis = next;
  }
}

using Quantize = Ends (*)(const std::array<Color, 2>& ends, int variant);

// Ends that serve the chosen indices best: a least-squares line for each channel.
std::array<Color, 2> Refined(const Planes& texels, const Weights& weights, const Line& line) {
  float aa = 0, ab = 0, bb = 0;
  Color a{}, b{};
  for (size_t i = 0; i < 16; ++i) {
    if (!IsOn(line, i)) continue;
    const float t = static_cast<float>(At(line.steps, line.indices[i])) / 64;
    const float w = weights[i];
    aa += w * (1 - t) * (1 - t);
    ab += w * (1 - t) * t;
    bb += w * t * t;
    for (size_t c = 0; c < 4; ++c) {
      a[c] += w * (1 - t) * texels.At(c, i);
      b[c] += w * t * texels.At(c, i);
    }
  }
  std::array<Color, 2> ends{};
  const float det = aa * bb - ab * ab;
  for (size_t c = 0; c < 4; ++c) {
    if (std::abs(det) < 1e-4f) {
      ends[0][c] = static_cast<float>(line.ends[0][c]), ends[1][c] = static_cast<float>(line.ends[1][c]);
    } else {
      ends[0][c] = std::clamp((a[c] * bb - b[c] * ab) / det, 0.0f, 255.0f);
      ends[1][c] = std::clamp((b[c] * aa - a[c] * ab) / det, 0.0f, 255.0f);
    }
  }
  return ends;
}

void Solve(const Planes& texels, const Weights& weights, Quantize quantize, int variants, int refinements, Line* line) {
  Color mean, axis;
  PrincipalAxis(texels, weights, *line, &mean, &axis);
  float least = 0, most = 0;
  for (size_t i = 0; i < 16; ++i) {
    if (!IsOn(*line, i)) continue;
    float along = 0;
    for (size_t c = line->first; c < line->first + line->count; ++c) along += axis[c] * (texels.At(c, i) - mean[c]);
    if (weights[i] < 0.05f) continue;
    least = std::min(least, along);
    most = std::max(most, along);
  }
  std::array<Color, 2> ends{};
  for (size_t c = 0; c < 4; ++c) {
    ends[0][c] = std::clamp(mean[c] + least * axis[c], 0.0f, 255.0f);
    ends[1][c] = std::clamp(mean[c] + most * axis[c], 0.0f, 255.0f);
  }
  for (int round = 0; round < refinements; ++round) {
    const double before = line->error;
    for (int v = 0; v < variants; ++v) Fit(texels, weights, quantize(ends, v), line);
    if (line->error >= before) break;
    ends = Refined(texels, weights, *line);
  }
}

// Mode 6: seven bits a channel and one bit for all channels of an end.
Ends QuantizeMode6(const std::array<Color, 2>& ends, int variant) {
  Ends out{};
  for (size_t e = 0; e < 2; ++e) {
    const int last = variant >> e & 1;
    for (size_t c = 0; c < 4; ++c) {
      out[e][c] =
          std::clamp(static_cast<int>(std::lround((ends[e][c] - static_cast<float>(last)) / 2)), 0, 127) << 1 | last;
    }
  }
  return out;
}

// Mode 5: seven bits a colour channel, eight of alpha.
Ends QuantizeMode5(const std::array<Color, 2>& ends, int) {
  Ends out{};
  for (size_t e = 0; e < 2; ++e) {
    for (size_t c = 0; c < 4; ++c) {
      const int bits = static_cast<int>(std::lround(ends[e][c] * 127 / 255));
      out[e][c] = c < 3 ? bits << 1 | bits >> 6 : static_cast<int>(std::lround(ends[e][c]));
    }
  }
  return out;
}

// Mode 1: six bits a colour channel, and one for both ends.
Ends QuantizeMode1(const std::array<Color, 2>& ends, int last) {
  Ends out{};
  for (size_t e = 0; e < 2; ++e) {
    for (size_t c = 0; c < 3; ++c) {
      const int bits =
          std::clamp(static_cast<int>(std::lround((ends[e][c] * 127 / 255 - static_cast<float>(last)) / 2)), 0, 63)
              << 1 |
          last;
      out[e][c] = bits << 1 | bits >> 6;
    }
  }
  return out;
}

// Mode 7: five bits a channel, and one for all channels of an end.
Ends QuantizeMode7(const std::array<Color, 2>& ends, int variant) {
  Ends out{};
  for (size_t e = 0; e < 2; ++e) {
    const int last = variant >> e & 1;
    for (size_t c = 0; c < 4; ++c) {
      const int bits =
          std::clamp(static_cast<int>(std::lround((ends[e][c] * 63 / 255 - static_cast<float>(last)) / 2)), 0, 31)
              << 1 |
          last;
      out[e][c] = bits << 2 | bits >> 4;
    }
  }
  return out;
}

// Sums over some texels from which follows how far they lie from one line.
struct Moments {
  float weight = 0;
  std::array<float, 4> first{};
  std::array<float, 10> second{};  // upper half
};

Moments operator-(Moments a, const Moments& b) {
  a.weight -= b.weight;
  for (size_t i = 0; i < a.first.size(); ++i) a.first[i] -= b.first[i];
  for (size_t i = 0; i < a.second.size(); ++i) a.second[i] -= b.second[i];
  return a;
}

void Add(const Moments& b, Moments* a) {
  a->weight += b.weight;
  for (size_t i = 0; i < a->first.size(); ++i) a->first[i] += b.first[i];
  for (size_t i = 0; i < a->second.size(); ++i) a->second[i] += b.second[i];
}

Moments MomentsOf(const std::array<uint8_t, 4>& texel, float weight) {
  std::array<float, 4> v{};
  for (size_t c = 0; c < 4; ++c) v[c] = static_cast<float>(texel[c]);
  Moments m{weight, {}, {}};
  size_t k = 0;
  for (size_t c = 0; c < 4; ++c) {
    m.first[c] = weight * v[c];
    for (size_t d = c; d < 4; ++d) m.second[k++] = weight * v[c] * v[d];
  }
  return m;
}

// Summed squares of the distances from the line that fits best: the variance less that along it.
float OffLine(const Moments& m) {
  if (m.weight < 1e-3f) return 0;
  Four spread[4];  // columns, and rows as well
  float all = 0;
  size_t k = 0;
  for (size_t c = 0; c < 4; ++c) {
    for (size_t d = c; d < 4; ++d, ++k) spread[c][d] = spread[d][c] = m.second[k] - m.first[c] * m.first[d] / m.weight;
    all += spread[c][c];
  }
  Four axis{1, 1, 1, 1};
  float most = 0;
  for (int round = 0; round < 4; ++round) {
    Four next{};
    for (size_t d = 0; d < 4; ++d) next += spread[d] * axis[d];
    const Four squares = next * next;
    const float length = squares[0] + squares[1] + squares[2] + squares[3];
    if (length < 1e-6f) return all;
    most = std::sqrt(length);
    axis = next / most;
  }
  return std::max(0.0f, all - most);
}

// The partitions whose two parts lie nearest to a line each, best first.
std::array<size_t, kTried> LikelyPartitions(const BlockTexels& texels, const Weights& weights) {
  std::array<Moments, 16> of_texel;
  Moments all;
  for (size_t i = 0; i < 16; ++i) Add(of_texel[i] = MomentsOf(texels[i], weights[i]), &all);
  std::array<std::pair<float, size_t>, kBc7Partitions.size()> order;
  for (size_t p = 0; p < order.size(); ++p) {
    Moments second;
    for (size_t i = 0; i < 16; ++i) {
      if ((kBc7Partitions[p] >> i & 1) != 0) Add(of_texel[i], &second);
    }
    order[p] = {OffLine(second) + OffLine(all - second), p};
  }
  std::partial_sort(order.begin(), order.begin() + kTried, order.end());
  std::array<size_t, kTried> likely{};
  for (size_t k = 0; k < kTried; ++k) likely[k] = order[k].second;
  return likely;
}

// An index at `anchor` is written with one bit less: its highest bit must be 0.
void TurnAround(size_t anchor, Line* line) {
  const int most = Count(line->steps) - 1;
  if (line->indices[anchor] * 2 <= most) return;
  std::swap(line->ends[0], line->ends[1]);
  for (int& index : line->indices) index = most - index;
}

void PutIndices(const Line& line, int bits, BitWriter* out) {
  for (size_t i = 0; i < 16; ++i) out->Put(line.indices[i], i == 0 ? bits - 1 : bits);
}

void WriteMode6(Line line, std::span<uint8_t, 16> block) {
  TurnAround(0, &line);
  BitWriter out(block);
  out.Put(1 << 6, 7);
  for (size_t c = 0; c < 4; ++c) {
    for (size_t e = 0; e < 2; ++e) out.Put(line.ends[e][c] >> 1, 7);
  }
  for (size_t e = 0; e < 2; ++e) out.Put(line.ends[e][0] & 1, 1);
  PutIndices(line, 4, &out);
}

void WriteMode5(Line color, Line alpha, std::span<uint8_t, 16> block) {
  TurnAround(0, &color);
  TurnAround(0, &alpha);
  BitWriter out(block);
  out.Put(1 << 5, 6);
  out.Put(0, 2);
  for (size_t c = 0; c < 3; ++c) {
    for (size_t e = 0; e < 2; ++e) out.Put(color.ends[e][c] >> 1, 7);
  }
  for (size_t e = 0; e < 2; ++e) out.Put(alpha.ends[e][3], 8);
  PutIndices(color, 2, &out);
  PutIndices(alpha, 2, &out);
}

// Two lines that share out a block's texels.
struct Pair {
  size_t partition = 0;
  bool with_alpha = false;
  std::array<Line, 2> lines;
  double error = 1e30;
};

Pair SolvePair(const Planes& texels, const Weights& weights, size_t partition, bool with_alpha) {
  Pair pair{partition, with_alpha, {}, 0};
  for (size_t k = 0; k < 2; ++k) {
    Line& line = pair.lines[k];
    line.count = with_alpha ? 4 : 3;
    line.steps = with_alpha ? std::span<const int>(kBc7TwoBitWeights) : std::span<const int>(kBc7ThreeBitWeights);
    line.members = k == 1 ? kBc7Partitions[partition] : ~uint32_t{kBc7Partitions[partition]} & 0xFFFF;
    Solve(texels, weights, with_alpha ? QuantizeMode7 : QuantizeMode1, with_alpha ? 4 : 2, kRefinements, &line);
    pair.error += line.error;
  }
  return pair;
}

void WritePair(Pair pair, std::span<uint8_t, 16> block) {
  const size_t anchors[] = {0, kBc7Anchors[pair.partition]};
  for (size_t k = 0; k < 2; ++k) TurnAround(anchors[k], &pair.lines[k]);
  BitWriter out(block);
  out.Put(pair.with_alpha ? 1 << 7 : 1 << 1, pair.with_alpha ? 8 : 2);
  out.Put(static_cast<int>(pair.partition), 6);
  const int less = pair.with_alpha ? 3 : 2, width = pair.with_alpha ? 5 : 6;  // bits that are not an end's own
  for (size_t c = 0; c < pair.lines[0].count; ++c) {
    for (const Line& line : pair.lines) {
      for (const auto& end : line.ends) out.Put(end[c] >> less, width);
    }
  }
  for (const Line& line : pair.lines) {
    for (size_t e = 0; e < (pair.with_alpha ? 2 : 1); ++e) out.Put(line.ends[e][0] >> (less - 1) & 1, 1);
  }
  const int bits = pair.with_alpha ? 2 : 3;
  for (size_t i = 0; i < 16; ++i) {
    const Line& line = pair.lines[kBc7Partitions[pair.partition] >> i & 1u];
    out.Put(line.indices[i], i == anchors[0] || i == anchors[1] ? bits - 1 : bits);
  }
}

bool AllAlphas(const BlockTexels& texels, uint8_t alpha) {
  return std::all_of(texels.begin(), texels.end(), [alpha](const auto& texel) { return texel[3] == alpha; });
}

}  // namespace

void CompressBc7(const BlockTexels& texels, const std::array<float, 16>& weights, std::span<uint8_t, 16> block) {
  constexpr Weights kAllAlike{1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  const bool unseen = AllAlphas(texels, 0);
  const Planes planes = PlanesOf(texels);
  Line together{0, 4, kBc7FourBitWeights, 0xFFFF, {}, {}};
  Solve(planes, weights, QuantizeMode6, unseen ? 1 : 4, unseen ? 1 : kRefinements, &together);
  if (unseen || together.error < kGoodEnough) return WriteMode6(together, block);
  Line color{0, 3, kBc7TwoBitWeights, 0xFFFF, {}, {}}, alpha{3, 1, kBc7TwoBitWeights, 0xFFFF, {}, {}};
  Solve(planes, weights, QuantizeMode5, 1, kRefinements, &color);
  Solve(planes, kAllAlike, QuantizeMode5, 1, kRefinements, &alpha);
  Pair pair;
  for (size_t partition : LikelyPartitions(texels, weights)) {
    Pair next = SolvePair(planes, weights, partition, !AllAlphas(texels, 255));
    if (next.error < pair.error) pair = next;
  }
  if (pair.error < std::min(together.error, color.error + alpha.error)) WritePair(pair, block);
  else if (together.error <= color.error + alpha.error) WriteMode6(together, block);
  else WriteMode5(color, alpha, block);
}

void CompressBc4(const std::array<uint8_t, 16>& values, std::span<uint8_t, 8> block) {
  stb_compress_bc4_block(block.data(), values.data());
}

}  // namespace flaneur
