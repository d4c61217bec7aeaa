// Parts of a town that turn. Structs alone; ground plane x east, y north, z up, metres.
#pragma once
#include <cstdint>

#include "runtime/base/math.h"

namespace flaneur {

// What makes a part of the town turn: the wind a weathercock, the hour of the day the hands of a clock.
enum class TurnsBy : uint8_t { kNothing, kWind, kHourHand, kMinuteHand };

inline const char* TurnsByName(TurnsBy by) {
  switch (by) {
    case TurnsBy::kNothing:
      return "";
    case TurnsBy::kWind:
      return "wind";
    case TurnsBy::kHourHand:
      return "hour_hand";
    case TurnsBy::kMinuteHand:
      return "minute_hand";
  }
  return "";
}

inline constexpr int kMaxTurningParts = 200;

// About an axis through a point. Hands are modelled at twelve and turn clockwise for whoever looks against the axis.
struct TurningPart {
  TurnsBy by = TurnsBy::kWind;
  Vec3 pivot_m;
  Vec3 axis{0, 0, 1};  // unit; of the wind: up
  float yaw_rad = 0;   // of the wind: where the part that heads into the wind points to as it is modelled
};

}  // namespace flaneur
