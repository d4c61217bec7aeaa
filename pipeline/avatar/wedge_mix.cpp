#include "pipeline/avatar/wedge_mix.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace flaneur {
namespace {

constexpr float kSameUv = 1e-4f;  // uvs nearer than this are no seam
constexpr float kSameColor = 0.02f;

}  // namespace

bool NoSeam(const WedgeSurface::Wedge& a, const WedgeSurface::Wedge& b) {
  return a.mesh == b.mesh && Length(a.uv - b.uv) < kSameUv &&
         std::max({std::abs(a.color.x - b.color.x), std::abs(a.color.y - b.color.y), std::abs(a.color.z - b.color.z)}) <
             kSameColor;
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
  std::map<uint16_t, float> sums;
  for (size_t i = 0; i < 4; ++i) sums[a->joints[i]] += (1 - t) * a->weights[i];
  for (size_t i = 0; i < 4; ++i) sums[b.joints[i]] += t * b.weights[i];
  std::vector<std::pair<uint16_t, float>> all(sums.begin(), sums.end());
  std::stable_sort(all.begin(), all.end(), [](const auto& x, const auto& y) { return x.second > y.second; });
  all.resize(4);
  const float sum = all[0].second + all[1].second + all[2].second + all[3].second;
  for (size_t i = 0; i < 4; ++i) {
    const bool used = all[i].second > 0;
    a->weights[i] = used ? all[i].second / sum : 0;
    a->joints[i] = used ? all[i].first : uint16_t{0};
  }
}

}  // namespace flaneur
