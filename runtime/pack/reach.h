// How far an avatar's people reach about the place where they stand, where a pack does not say it. Internal to
// runtime/pack.
#pragma once
#include "runtime/pack/tour_pack.h"

namespace flaneur {

// Metres on the ground, of the figure without props, by the outlines of its impostor's pictures.
float ReachOfPictures_m(const ImpostorLayout& impostor);

// Of a mesh in all frames of the clip.
float PosedReach_m(const PackMesh& mesh, const PackClip& clip, int joints);

}  // namespace flaneur
