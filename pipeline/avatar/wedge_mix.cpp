#include "pipeline/avatar/wedge_mix.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flaneur {
namespace {

constexpr float kSameUv = 1e-4f;  // uvs nearer than this are no seam
constexpr float kSameColor = 0.02f;

}  // namespace

bool NoSeam(const WedgeSurface::Wedge& a, const WedgeSurface::Wedge& b) {
  return a.mesh == b.mesh && Length(a.uv - b.uv) < kSameUv &&
         std::max({std::abs(a.color.x - b.color.x), std::abs(a.color.y - b.color.y),
                   std::abs(a.color.z - b.color.z)}) < kSameColor;
}

WedgeSurface::Wedge Mix(const WedgeSurface::Wedge& a, const WedgeSurface::Wedge& b, float t) {
  WedgeSurface::Wedge out = a;
  out.normal = Normalized(a.normal * (1 - t) + b.normal * t);
  if (!(Length(out.normal) > 0.5f)) out.normal = a.normal;
  out.uv = a.uv * (1 - t) + b.uv * t;
  out.uv1 = a.uv1 * (1 - t) + b.uv1 * t;
  out.color = {a.color.x + t * (b.color.x - a.color.x), a.color.y + t * (b.color.y - a.color.y),
               a.color.z + t * (b.color.z - a.color.z), a.color.w + t * (b.color.w - a.color.w)};
  return out;
}

float WeightDifference(const WedgeSurface::Vertex& a, const WedgeSurface::Vertex& b) {
  float sum = 0;
  for (size_t i = 0; i < 4; ++i) {
    float in_b = 0;
    for (size_t k = 0; k < 4; ++k) {
      if (b.joints[k] == a.joints[i]) in_b += b.weights[k];
    }
    sum += std::max(a.weights[i] - in_b, 0.0f);
  }
  return 2 * sum;
}

void MixWeights(const WedgeSurface::Vertex& b, float t, WedgeSurface::Vertex* a) {
  std::array<std::pair<float, uint16_t>, 8> all{};
  size_t count = 0;
  const auto add = [&](uint16_t joint, float weight) {
    if (!(weight > 0)) return;
    for (size_t i = 0; i < count; ++i) {
      if (all[i].second != joint) continue;
      all[i].first += weight;
      return;
    }
    all[count++] = {weight, joint};
  };
  for (size_t i = 0; i < 4; ++i) add(a->joints[i], (1 - t) * a->weights[i]);
  for (size_t i = 0; i < 4; ++i) add(b.joints[i], t * b.weights[i]);
  std::stable_sort(all.begin(), all.end(), [](auto x, auto y) {
    return x.first != y.first ? x.first > y.first : x.second < y.second;
  });
  float sum = 0;
  for (size_t i = 0; i < std::min<size_t>(count, 4); ++i) sum += all[i].first;
  for (size_t i = 0; i < 4; ++i) {
    const bool used = i < count && sum > 0;
    a->weights[i] = used ? all[i].first / sum : 0;
    a->joints[i] = used ? all[i].second : uint16_t{0};
  }
}

}  // namespace flaneur
