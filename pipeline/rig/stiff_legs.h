// Walking on legs of one bone each, as toys have them: nothing bends, so hips and legs make room for the steps.
#pragma once
#include <array>
#include <vector>

#include "pipeline/rig/steps.h"
#include "runtime/base/math.h"

namespace flaneur {

struct StiffWalk {
  float speed = 0;           // units a second along +Z; 0: it goes nowhere, and the rest is empty
  float aside_rad = 0;       // how far to the left of +Z it goes, which nothing is done about
  std::vector<Vec3> middle;  // by key, of the hip joints: what stands then rolls over ground that goes back at `speed`
  std::array<std::vector<float>, 2> lift;  // by key, of either leg at its hip joint, so that what stands is on the
                                           // ground and what swings is clear of it
};

// `soles`: of both feet by key, against the middle of the hip joints, legs turned as they will be. The last key is the
// first. leg_m: from hip joint to ankle.
StiffWalk WalkOnStiffLegs(const std::array<Soles, 2>& soles, float step_s, float leg_m);

}  // namespace flaneur
