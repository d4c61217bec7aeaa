// Round the visitor, and the guide: people see early that somebody is in their way, and bend it. Internal to
// runtime/crowd.
#pragma once
#include <vector>

#include "runtime/crowd/crowd.h"

namespace flaneur {

// Somebody who walks: where to, and round whom.
struct Walking {
  Vec2 position, way;  // way: unit vector
  float radius_m = 0, speed_mps = 0;
  float goal_m = 1e9f;  // away, where they walk straight to it
};

// Of discs that are for everyone and have a room; of others people only step aside.
// The way to take: `way`, or the one nearest to it that passes all discs which are for everyone, as far as walls let
// people pass: with their room and between nobody who talks if there is any such way, else with their room, else
// without touching. side: -1 where they go round on the right, 1 on the left, 0 where nothing is in their way; they
// keep to it unless the other one is much shorter.
Vec2 WayRound(const Walkable& w, const std::vector<MovingObstacle>& moving, const Walking& me, int8_t* side);

}  // namespace flaneur
