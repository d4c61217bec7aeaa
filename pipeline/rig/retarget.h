// A clip of one person's skeleton made to fit another's.
#pragma once
#include <string>

#include "pipeline/core/avatar.h"
#include "pipeline/rig/rig.h"

namespace flaneur {

struct Retargeted {
  Clip clip;  // on the target's joints, in the target's own space
  // In the target's unit, along the reference pose's +Z; 0: the clip goes nowhere, or on legs of one bone, whose soles
  // alone tell.
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

// Of the soles of a walk on its own skeleton over the ground, as a share of its speed; 0 where it tells none.
float SlideOfWalk(const Rig& rig, const Clip& walk);

// Sets the feet of a walk on its own skeleton anew, where they slide over the ground and can be kept from it; false
// where nothing is changed. The rig is one that names tell and that bends its knees.
bool PlantFeet(const Rig& rig, Retargeted* walk);

// A joint's name without what stands before it for the rig's own: "mixamorig:Hips" is "Hips".
std::string BareName(const std::string& name);

// Whether nearly every joint of `target` has one of its name, parent and rest in `source`, so that clips fit as they
// are. `scale`: of the target's lengths against the source's.
bool SameSkeleton(const std::vector<Joint>& source, const std::vector<Joint>& target, float* scale);

// A clip by joint names alone: each joint turns and moves from its own rest as the source's does from its. For figures
// that are no humans. Joints that the source lacks keep their rest. Returns how many joints were found.
int CopyClip(const std::vector<Joint>& source, const Clip& clip, const std::vector<Joint>& target, Clip* copied);

}  // namespace flaneur
