// An obstacle that is a box along the axes.
#pragma once
#include "runtime/pack/tour_pack.h"

namespace flaneur {

inline PackObstacle Box(Vec2 min, Vec2 max) {
  PackObstacle o;
  o.outer = {min, {max.x, min.y}, max, {min.x, max.y}};
  return o;
}

}  // namespace flaneur
