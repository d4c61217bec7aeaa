// Clips in which nobody takes a step: who breathes, gestures, or sits in a chair, a cart or a saddle.
#pragma once
#include "pipeline/core/avatar.h"
#include "pipeline/rig/rig.h"

namespace flaneur {

// Whether both ankles stay where they are below their hip joints, but for an eighth of the leg's length.
bool KeepsLegsStill(const Rig& rig, const Clip& clip);

// Whether the legs keep still and the thighs lie rather than hang.
bool Sits(const Rig& rig, const Clip& clip);

// Gives legs, hips and what they hang on, in all keys of `clip`, the pose that they begin `seated` with. Both clips are
// on the rig's joints in their own space.
void KeepSeated(const Rig& rig, const Clip& seated, Clip* clip);

}  // namespace flaneur
