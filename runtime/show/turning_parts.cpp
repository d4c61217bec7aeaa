#include "runtime/show/turning_parts.h"

#include <cmath>

#include "runtime/crowd/fast_math.h"
#include "runtime/show/wind.h"

namespace flaneur {
namespace {

constexpr float kLags_s = 1.5f;  // behind the wind

float TurnOf_rad(const TurningPart& part, const WindSettings& wind, float time_s, float hour) {
  switch (part.by) {
    case TurnsBy::kNothing:
      return 0;
    case TurnsBy::kWind: {
      if (wind.speed_mps <= 0) return 0;
      // Each a little apart from the others, as gusts pass.
      const Vec2 blows = WindAt(wind, time_s - kLags_s - 0.05f * (part.pivot_m.x + part.pivot_m.y));
      return WrapAngle(std::atan2(-blows.y, -blows.x) - part.yaw_rad);
    }
    case TurnsBy::kHourHand:
      return -2 * kPi * std::fmod(hour, 12.0f) / 12;
    case TurnsBy::kMinuteHand:
      return -2 * kPi * (hour - std::floor(hour));
  }
  return 0;
}

}  // namespace

void TurnParts(const TourPack& pack, float time_s, float hour, FrameInput* frame) {
  frame->turns_rad.clear();
  for (const TurningPart& part : pack.turning) frame->turns_rad.push_back(TurnOf_rad(part, pack.wind, time_s, hour));
}

}  // namespace flaneur
