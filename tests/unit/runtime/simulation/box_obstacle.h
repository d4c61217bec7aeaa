// An obstacle that is a box along the axes.
#pragma once
#include "runtime/tour_data/tour_data.h"

namespace flaneur {

inline PolygonObstacle Box(Vec2 min, Vec2 max) { return {{min, {max.x, min.y}, max, {min.x, max.y}}, {}}; }

}  // namespace flaneur
