// What lives and moves in a town besides its people. Structs alone; ground plane x east, y north, z up, metres.
#pragma once
#include <cstdint>
#include <string>

#include "runtime/base/math.h"

namespace flaneur {

inline constexpr int kMaxBirds = 200;  // of all flocks together
inline constexpr float kMaxFlockRadius_m = 50, kMaxShy_m = 20;

// Birds that walk and peck about a place and fly up when somebody comes near.
struct Flock {
  std::string avatar;  // its name: walk and idle are what it does on the ground
  Vec2 position_m;
  float radius_m = 5;
  int birds = 12;
  float shy_m = 2.5f;  // before a visitor who is nearer they fly up; before townspeople, whom they know, at 0.4 of it
  std::string clip = "fly";  // in the air
};

inline constexpr size_t kMaxSmokes = 1000;
inline constexpr float kLeastSmoke_m = 0.1f, kMostSmoke_m = 5;

// What rises over a chimney and drifts with the wind.
struct Smoke {
  Vec3 position_m;       // of the chimney's mouth, in the town's own coordinates
  float width_m = 0.5f;  // there
  float density = 0.7f;  // 0 to 1: how much it hides at its thickest
};

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
