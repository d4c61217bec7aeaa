// Walking to where the visitor points. Internal to runtime/walk.
#pragma once
#include <optional>

#include "runtime/walk/route.h"

namespace flaneur {

struct CameraState;
struct VisitorInTown;

// The way to the place that was pointed at; no points: nowhere.
struct PointWalk {
  Route route;
  float way_m = 0;
  Corner corner;
};

// The ground seen at a place of the picture, 0 to 1 from its upper left corner: where the ray through it meets the
// ground, or the last ground before what stands in the way. None within sight: looking into the sky.
std::optional<Vec2> GroundAt(const Walkable& walkable, const CameraState& camera, Vec2 place, float aspect);

// Sets out for the nearest place that one can walk to.
void SetOut(Vec2 place, const VisitorInTown& v);

}  // namespace flaneur
