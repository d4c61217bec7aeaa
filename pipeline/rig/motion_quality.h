// How well a person moves: figures that need no eye.
#pragma once
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/rig/rig.h"

namespace flaneur {

// What points of the body near the ground move over it, as a share of the speed: the median over the points of each
// key, then the mean over the keys in which any is there. `band`: of the person's height. The person stands at y = 0,
// faces +Z and walks on the spot.
float FootSlide(const Avatar& person, const Clip& walk, float speed_mps, float band = 0.012f);

// How high the hip joints are above standing ankles, in legs, as a mean over the clip: the same in a clip and in what
// is retargeted from it.
float HipsHeight(const Rig& rig, const Clip& clip);

// By how much a knee or an elbow bends the wrong way at most, in radians, anywhere in the clip.
float WrongBend(const Rig& rig, const Clip& clip);

// How deep hand or forearm of a side are in trunk or thighs at most, in metres, over `keys` moments of the clip.
float HandDepth(const Avatar& person, const Rig& rig, const Clip& clip, size_t side, int keys);

// Turns both upper arms outwards, alike in all keys, by as much as lets hands and forearms clear trunk and thighs, or
// by 45 degrees. `clip` is on the rig's joints in their own space. Returns the greater of the two angles, in degrees.
float ClearHands(const Avatar& person, const Rig& rig, Clip* clip);

}  // namespace flaneur
