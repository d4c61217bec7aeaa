// Making room in a narrow lane. Internal to runtime/walk.
#pragma once
#include "runtime/base/math.h"

namespace flaneur {

struct VisitorInTown;

// The way of a visitor who is led along the unit vector `way`: to one side where somebody comes towards them who finds
// no room to pass otherwise, the right first as people do; else `way`.
Vec2 StepAside(const VisitorInTown& v, Vec2 way);

// Share of the pace of a visitor who is led along `way`: less behind somebody who goes before them where there is no
// room to pass, so that no back fills the view.
float PaceBehind(const VisitorInTown& v, Vec2 way);

// Whether somebody of this radius, who goes along `way` or comes against it, gets past a visitor who stands at p.
bool LetsPass(const VisitorInTown& v, Vec2 p, Vec2 way, float radius_m);

}  // namespace flaneur
