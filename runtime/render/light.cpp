#include "runtime/render/light.h"

#include <algorithm>

namespace flaneur {
namespace {

Vec3 Mix(Vec3 a, Vec3 b, float t) { return a * (1 - t) + b * t; }
float Smooth(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

}  // namespace

// By the sine of the sun's height: its colour warms and fades towards the horizon, where the haze glows; below it dusk
// falls.
Light LightFor(Vec3 to_sun) {
  const float day = Smooth(-0.14f, 0.30f, to_sun.y), low = 1 - Smooth(0.05f, 0.55f, to_sun.y);
  const float dusk = Smooth(-0.20f, 0.0f, to_sun.y) * (1 - Smooth(0.04f, 0.34f, to_sun.y));
  const float strength = 3.4f * std::clamp((to_sun.y + 0.02f) / 0.2f, 0.0f, 1.0f);
  Light light;
  light.sun = Vec3{1.0f, 0.92f - 0.26f * low, 0.78f - 0.44f * low} * strength;
  light.sky = Mix({0.05f, 0.06f, 0.11f}, Mix({0.62f, 0.72f, 0.92f}, {0.44f, 0.42f, 0.52f}, dusk), day);
  light.ground = Mix({0.03f, 0.03f, 0.04f}, Mix({0.42f, 0.36f, 0.30f}, {0.30f, 0.22f, 0.18f}, dusk), day);
  light.haze = Mix({0.03f, 0.04f, 0.08f}, Mix({0.78f, 0.80f, 0.84f}, {0.98f, 0.62f, 0.40f}, dusk), day);
  light.zenith = Mix({0.01f, 0.015f, 0.04f}, Mix({0.20f, 0.40f, 0.78f}, {0.20f, 0.28f, 0.52f}, dusk), day);
  return light;
}

}  // namespace flaneur
