// Flocks of birds: they walk and peck about a place, fly up when somebody comes near, circle over it, and settle again
// where nobody is. They are no people: nobody gives way to them, and people's ways are the same with and without them.
#pragma once
#include <cstdint>
#include <vector>

#include "runtime/base/math.h"
#include "runtime/base/random.h"
#include "runtime/tour_data/life_data.h"

namespace flaneur {

struct Town;

enum class BirdState : uint8_t { kPecks, kWalks, kFlies, kLands };
inline bool InTheAir(BirdState state) { return state == BirdState::kFlies || state == BirdState::kLands; }

struct Bird {
  Vec3 position, before;  // before: one step ago
  Vec3 velocity;          // in the air
  float heading_rad = 0, heading_before_rad = 0;
  BirdState state = BirdState::kPecks;
  BirdState last = BirdState::kPecks;  // before this one
  float since_s = 0;                   // of the state
  float left_s = 0;                    // of it; below zero on the ground: until it takes off with the others
  float walked_m = 0;
  Vec2 to;                          // where it walks or lands
  float round_rad = 0, high_m = 0;  // while it circles: where on the round, and over the place
};

struct FlockState {
  Flock place;
  int avatar = 0;      // index into Town::residents
  float ground_m = 0;  // height of the place
  float round_m = 0;   // radius of their rounds over it
  std::vector<Bird> birds;
  Random random;  // of its own
};

// The birds on the ground. Those with no free ground, or of an avatar that there is not or that cannot fly, are left
// out with a warning.
void PlaceFlocks(const std::vector<Flock>& flocks, Town* town);

// visitor: who frightens them; present: false where there is none. Flocks far from the visitor rest.
void StepFlocks(Vec2 visitor, bool present, float step_s, Town* town);

}  // namespace flaneur
