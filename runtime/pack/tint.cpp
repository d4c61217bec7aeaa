#include "runtime/pack/tint.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

constexpr float kLeastLightness = 0.04f;  // of a cloth, so that next to black nothing is divided by nothing

constexpr float kBoundShade = 0.25f;  // of the way into shadow, what counts as another colour where tints are bound

float Lightness(Vec3 color) { return Dot(color, {0.30f, 0.59f, 0.11f}); }

// In folds, darker than the cloth, as much less of its colour.
float InFold(const Tint& tint, Vec3 color) {
  return std::min(1.0f, Lightness(color) / std::max(kLeastLightness, Lightness(tint.color)));
}

}  // namespace

Vec3 WithHalfLightness(Vec3 color) {
  const float half = 0.5f * Lightness(color);
  return color - Vec3{half, half, half};
}

float TintShare(const Tint& tint, Vec3 color) {
  const float shade = tint.by_material ? std::lerp(InFold(tint, color), 1.0f, kBoundShade) : 1;
  const float distance = Length(WithHalfLightness(color) - WithHalfLightness(tint.color) * shade) / tint.reach;
  return std::clamp(2 - 2 * distance * distance, 0.0f, 1.0f);
}

Vec3 Tinted(const std::vector<Tint>& tints, const std::vector<size_t>& chosen, Vec3 color) {
  Vec3 out = color;
  float left = 1;
  for (size_t k = 0; k < tints.size() && k < chosen.size(); ++k) {
    const float share = std::min(left, TintShare(tints[k], color));
    left -= share;
    if (chosen[k] > 0)
      out = out + (tints[k].colors[chosen[k] - 1] - tints[k].color) * (share * InFold(tints[k], color));
  }
  return {std::clamp(out.x, 0.0f, 1.0f), std::clamp(out.y, 0.0f, 1.0f), std::clamp(out.z, 0.0f, 1.0f)};
}

}  // namespace flaneur
