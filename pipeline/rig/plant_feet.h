// Walks whose feet slide over the ground, mended on their own skeleton.
#pragma once
#include "pipeline/rig/retarget.h"

namespace flaneur {

// Of the soles of a walk on its own skeleton over the ground, as a share of its speed; 0 where it tells none.
float SlideOfWalk(const Rig& rig, const Clip& walk);

// Whether the soles that stand push the ground ahead. Of a rig that names tell: a shape's front may be its back.
bool GoesBackwards(const Rig& rig, const Clip& walk);

// Sets the feet of a walk on its own skeleton anew, where they slide over the ground and can be kept from it; false
// where nothing is changed. The rig is one that names tell and that bends its knees.
bool PlantFeet(const Rig& rig, Retargeted* walk);

}  // namespace flaneur
