// What lives and moves in a town besides its people. Structs alone; ground plane x east, y north, z up, metres.
#pragma once
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
inline constexpr double kLeastSmoke_m = 0.1, kMostSmoke_m = 5;

// What rises over a chimney and drifts with the wind.
struct Smoke {
  Vec3 position_m;       // of the chimney's mouth, in the town's own coordinates
  float width_m = 0.5f;  // there
  float density = 0.7f;  // 0 to 1: how much it hides at its thickest
};

}  // namespace flaneur
