#include "runtime/pack/tint.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

constexpr float kLeastLightness = 0.04f;  // of a cloth, so that next to black nothing is divided by nothing

float Lightness(Vec3 color) { return Dot(color, {0.30f, 0.59f, 0.11f}); }

}  // namespace

Vec3 WithHalfLightness(Vec3 color) {
  const float half = 0.5f * Lightness(color);
  return color - Vec3{half, half, half};
}

float TintShare(const Tint& tint, Vec3 color) {
  const float distance = Length(WithHalfLightness(color) - WithHalfLightness(tint.color)) / tint.reach;
  return std::clamp(2 - 2 * distance * distance, 0.0f, 1.0f);
}

Vec3 Tinted(const std::vector<Tint>& tints, const std::vector<size_t>& chosen, Vec3 color) {
  Vec3 out = color;
  float left = 1;
  for (size_t k = 0; k < tints.size() && k < chosen.size(); ++k) {
    const float share = std::min(left, TintShare(tints[k], color));
    left -= share;
    const float fold = std::min(1.0f, Lightness(color) / std::max(kLeastLightness, Lightness(tints[k].color)));
    if (chosen[k] > 0) out = out + (tints[k].colors[chosen[k] - 1] - tints[k].color) * (share * fold);
  }
  return {std::clamp(out.x, 0.0f, 1.0f), std::clamp(out.y, 0.0f, 1.0f), std::clamp(out.z, 0.0f, 1.0f)};
}

}  // namespace flaneur
