// A clip of one person's skeleton made to fit another's.
#pragma once
#include "pipeline/core/avatar.h"
#include "pipeline/rig/rig.h"

namespace flaneur {

struct Retargeted {
  Clip clip;  // on the target's joints, in the target's own space
  // In the target's unit, along the reference pose's +Z; 0: the clip goes nowhere.
  float walk_speed_mps = 0;
  float source_slide = 0;  // of the source's soles over the ground, as a share of its walking speed
};

struct RetargetOptions {
  bool walks = false;  // a foot is always on the ground
  float wider = 0;     // each foot is set down so much farther out, in legs
};

// Every limb points where the source's does, whatever pose each rests in. Trunk and head turn as the source's do,
// spread over as many joints as there are. Hips are as high above the ankles, measured in legs, as the source's. Feet
// that stand roll over the ground without sliding and without sinking in; knees bend forward to meet them. Fingers bend
// as the source's, or a little where it has none. Joints that no part of a body stands for keep their place on their
// parents. `clip` may travel or walk on the spot; it is on `source`'s joints, in their own space.
Retargeted Retarget(const Rig& source, const Clip& clip, const Rig& target, const RetargetOptions& options = {});

}  // namespace flaneur
