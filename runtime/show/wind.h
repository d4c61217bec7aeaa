// The wind at a moment; nothing is remembered.
#pragma once
#include <cmath>

#include "runtime/tour_data/settings.h"

namespace flaneur {

// Where it blows to, metres a second: gusts from either side, none where there is no wind.
inline Vec2 WindAt(const WindSettings& wind, float time_s) {
  const float yaw_rad = wind.yaw_rad + 0.3f * std::sin(0.11f * time_s) + 0.15f * std::sin(0.37f * time_s + 1);
  return Vec2{std::cos(yaw_rad), std::sin(yaw_rad)} * (wind.speed_mps * (1 + 0.2f * std::sin(0.23f * time_s)));
}

}  // namespace flaneur
