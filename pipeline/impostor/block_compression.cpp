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

#include "runtime/pack/texture.h"

namespace flaneur {
namespace {

using Color = std::array<float, 4>;
using Ends = std::array<std::array<int, 4>, 2>;
using Weights = std::array<float, 16>;

constexpr float kAlphaWeight = 2;  // an outline that moves shows more than a colour that is a little off
constexpr int kRefinements = 3;

// Bits of a block from the lowest on.
class BitWriter {
 public:
  explicit BitWriter(std::span<uint8_t, 16> bytes) : bytes_(bytes) { std::fill(bytes.begin(), bytes.end(), uint8_t{0}); }
  void Put(int value, int count) {
    for (int i = 0; i < count; ++i, ++at_) bytes_[at_ / 8] |= static_cast<uint8_t>((value >> i & 1) << (at_ % 8));
  }

 private:
  std::span<uint8_t, 16> bytes_;
  size_t at_ = 0;
};

// Some channels of a block as one line of colours: two ends, and for each texel how far it is along.
struct Line {
  size_t first = 0, count = 4;     // channels
  std::span<const int> steps;      // weights / 64 that an index stands for
  Ends ends{};
  std::array<int, 16> indices{};
  double error = 1e30;
};

int Between(int a, int b, int weight) { return ((64 - weight) * a + weight * b + 32) >> 6; }

// Error with the best indices for these ends.
void Fit(const BlockTexels& texels, const Weights& weights, const Ends& ends, Line* line) {
  std::array<std::array<int, 4>, 16> palette{};
  for (size_t s = 0; s < line->steps.size(); ++s) {
    for (size_t c = line->first; c < line->first + line->count; ++c) palette[s][c] = Between(ends[0][c], ends[1][c], line->steps[s]);
  }
  std::array<int, 16> indices{};
  double error = 0;
  for (size_t i = 0; i < 16; ++i) {
    float nearest = 1e30f;
    for (size_t s = 0; s < line->steps.size(); ++s) {
      float off = 0;
      for (size_t c = line->first; c < line->first + line->count; ++c) {
        const auto d = static_cast<float>(palette[s][c] - texels[i][c]);
        off += d * d * (c == 3 ? kAlphaWeight : weights[i]);
      }
      if (off < nearest) nearest = off, indices[i] = static_cast<int>(s);
    }
    error += static_cast<double>(nearest);
  }
  if (error >= line->error) return;
  line->ends = ends;
  line->indices = indices;
  line->error = error;
}

// The direction in which the colours differ most, by power iteration.
void PrincipalAxis(const BlockTexels& texels, const Weights& weights, const Line& line, Color* mean, Color* axis) {
  float sum = 1e-6f;
  *mean = {};
  for (size_t i = 0; i < 16; ++i) {
    sum += weights[i];
    for (size_t c = 0; c < 4; ++c) (*mean)[c] += weights[i] * static_cast<float>(texels[i][c]);
  }
  for (float& m : *mean) m /= sum;
  *axis = {1, 1, 1, 1};
  for (int round = 0; round < 6; ++round) {
    Color next{};
    for (size_t i = 0; i < 16; ++i) {
      float along = 0;
      for (size_t c = line.first; c < line.first + line.count; ++c) along += (*axis)[c] * (static_cast<float>(texels[i][c]) - (*mean)[c]);
      for (size_t c = 0; c < 4; ++c) next[c] += weights[i] * along * (static_cast<float>(texels[i][c]) - (*mean)[c]);
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
std::array<Color, 2> Refined(const BlockTexels& texels, const Weights& weights, const Line& line) {
  float aa = 0, ab = 0, bb = 0;
  Color a{}, b{};
  for (size_t i = 0; i < 16; ++i) {
    const float t = static_cast<float>(line.steps[static_cast<size_t>(line.indices[i])]) / 64;
    const float w = weights[i];
    aa += w * (1 - t) * (1 - t);
    ab += w * (1 - t) * t;
    bb += w * t * t;
    for (size_t c = 0; c < 4; ++c) {
      a[c] += w * (1 - t) * static_cast<float>(texels[i][c]);
      b[c] += w * t * static_cast<float>(texels[i][c]);
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

void Solve(const BlockTexels& texels, const Weights& weights, Quantize quantize, int variants, Line* line) {
  Color mean, axis;
  PrincipalAxis(texels, weights, *line, &mean, &axis);
  float least = 0, most = 0;
  for (size_t i = 0; i < 16; ++i) {
    float along = 0;
    for (size_t c = line->first; c < line->first + line->count; ++c) along += axis[c] * (static_cast<float>(texels[i][c]) - mean[c]);
    if (weights[i] < 0.05f) continue;
    least = std::min(least, along);
    most = std::max(most, along);
  }
  std::array<Color, 2> ends{};
  for (size_t c = 0; c < 4; ++c) {
    ends[0][c] = std::clamp(mean[c] + least * axis[c], 0.0f, 255.0f);
    ends[1][c] = std::clamp(mean[c] + most * axis[c], 0.0f, 255.0f);
  }
  for (int round = 0; round < kRefinements; ++round) {
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
      out[e][c] = std::clamp(static_cast<int>(std::lround((ends[e][c] - static_cast<float>(last)) / 2)), 0, 127) << 1 | last;
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

// The first index is written with one bit less: its highest bit must be 0.
void TurnAround(Line* line) {
  const int most = static_cast<int>(line->steps.size()) - 1;
  if (line->indices[0] * 2 <= most) return;
  std::swap(line->ends[0], line->ends[1]);
  for (int& index : line->indices) index = most - index;
}

void PutIndices(const Line& line, int bits, BitWriter* out) {
  for (size_t i = 0; i < 16; ++i) out->Put(line.indices[i], i == 0 ? bits - 1 : bits);
}

void WriteMode6(Line line, std::span<uint8_t, 16> block) {
  TurnAround(&line);
  BitWriter out(block);
  out.Put(1 << 6, 7);
  for (size_t c = 0; c < 4; ++c) {
    for (size_t e = 0; e < 2; ++e) out.Put(line.ends[e][c] >> 1, 7);
  }
  for (size_t e = 0; e < 2; ++e) out.Put(line.ends[e][0] & 1, 1);
  PutIndices(line, 4, &out);
}

void WriteMode5(Line color, Line alpha, std::span<uint8_t, 16> block) {
  TurnAround(&color);
  TurnAround(&alpha);
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

}  // namespace

void CompressBc7(const BlockTexels& texels, const std::array<float, 16>& weights, std::span<uint8_t, 16> block) {
  constexpr Weights kAllAlike{1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  Line together{0, 4, kBc7FourBitWeights};
  Solve(texels, weights, QuantizeMode6, 4, &together);
  Line color{0, 3, kBc7TwoBitWeights}, alpha{3, 1, kBc7TwoBitWeights};
  Solve(texels, weights, QuantizeMode5, 1, &color);
  Solve(texels, kAllAlike, QuantizeMode5, 1, &alpha);
  if (together.error <= color.error + alpha.error) WriteMode6(together, block);
  else WriteMode5(color, alpha, block);
}

void CompressBc4(const std::array<uint8_t, 16>& values, std::span<uint8_t, 8> block) {
  stb_compress_bc4_block(block.data(), values.data());
}

}  // namespace flaneur
