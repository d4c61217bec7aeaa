// Where a visit begins, and back to there. Internal to runtime/walk.
#pragma once
#include "runtime/base/math.h"

namespace flaneur {

struct Walkable;
struct VisitorInTown;

// Where to look from p where nobody has said it: to where most is to be seen whole, neither right before the eyes nor
// far.
float BestView_rad(const Walkable& walkable, Vec2 p);

struct Start {
  Vec2 position_m;
  float yaw_rad = 0, pitch_rad = 0;
};

// Where the visitor stands now, before the first step.
void RememberStart(const VisitorInTown& v);

// The visitor stands there again and the guide is with them; whatever leads them is at its beginning, and the tour
// waits (GuidedTour::begun). The town goes on as it is.
void GoToStart(const VisitorInTown& v);

}  // namespace flaneur
