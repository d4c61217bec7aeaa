// How well a person moves: figures that need no eye.
#pragma once
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/rig/retarget.h"
#include "pipeline/rig/rig.h"

namespace flaneur {

// What points of the feet near the ground move over it, as a share of the speed: the median over the points of each
// key, then the mean over the keys in which any is there; 0 where none ever is. The person stands at y = 0, faces +Z
// and walks on the spot.
float FootSlide(const Avatar& person, const Clip& walk, float speed_mps);

// How high the hip joints are above standing ankles, in legs, as a mean over the walk: the same in a walk and in what
// is retargeted from it.
float HipsHeight(const Rig& rig, const Clip& walk);

// By how much a knee, an ankle or an elbow bends further than a human's at most, or the wrong way, in radians, anywhere
// in the clip.
float PastLimits(const Rig& rig, const Clip& clip);

// How deep hand or forearm of a side are in trunk or thighs at most, in metres, over `keys` moments of the clip.
float HandDepth(const Avatar& person, const Rig& rig, const Clip& clip, size_t side, int keys);

// The same of one leg in the other, from the knees down.
float LegDepth(const Avatar& person, const Rig& rig, const Clip& clip, int keys);

// Retargets a walk, with feet set down farther apart where one leg would go through the other, up to a hand's breadth.
Retargeted ClearLegs(const Avatar& person, const Rig& source, const Clip& walk, const Rig& rig);

// Turns both upper arms outwards, alike in all keys, by as much as lets hands and forearms clear trunk and thighs, or
// by 45 degrees. `clip` is on the rig's joints in their own space. Returns the greater of the two angles, in degrees.
float ClearHands(const Avatar& person, const Rig& rig, Clip* clip);

}  // namespace flaneur
