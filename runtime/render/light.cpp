#include "runtime/render/light.h"

#include <algorithm>

namespace flaneur {

// The sun's colour warms and fades towards the horizon.
Light LightFor(Vec3 to_sun) {
  const float height = std::clamp(to_sun.y, 0.0f, 1.0f);
  const float low = 1 - std::clamp(height / 0.6f, 0.0f, 1.0f);
  const float strength = 3.4f * std::clamp((to_sun.y + 0.02f) / 0.2f, 0.0f, 1.0f);
  Light light;
  light.sun = Vec3{1.0f, 0.92f - 0.22f * low, 0.78f - 0.38f * low} * strength;
  light.sky = {0.62f, 0.72f, 0.92f};
  light.ground = {0.42f, 0.36f, 0.30f};
  light.haze = {0.78f + 0.10f * low, 0.80f, 0.84f - 0.08f * low};
  light.zenith = {0.20f, 0.40f, 0.78f};
  return light;
}

}  // namespace flaneur
