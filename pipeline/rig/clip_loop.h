// Clips made to walk on the spot and to loop.
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"

namespace flaneur {

// In seconds from the clip's beginning.
float TimeOf(const Clip& clip, int key);

// Of the clip's joints in one key, world. Unlike SkinningMatrices at a time, this does not wrap the last key to the
// first.
std::vector<Vec3> JointPositions(const std::vector<Joint>& joints, const Clip& clip, int key);

// Moves the whole figure, in one key or in all.
void ShiftClip(const std::vector<Joint>& joints, Clip* clip, int key, Vec3 by);
void ShiftClip(const std::vector<Joint>& joints, Clip* clip, Vec3 by);

// Turns the whole figure about the origin.
void TurnClip(Quat turn, const std::vector<Joint>& joints, Clip* clip);

// Takes even horizontal travel out of the clip; returns its velocity. `height`: of the figure; less than a twentieth of
// it is sway. `axis`: the vertical.
Vec3 RemoveTravel(const std::vector<Joint>& joints, float height, Clip* clip);

// Makes the last key equal the first: exactly where it nearly does, by one more key where just that is missing, else by
// blending the clip's end into its first pose.
void MakeLoop(const std::vector<Joint>& joints, Clip* clip, std::vector<std::string>* warnings);

// Leaves out the keys at either end, of three at most, from which the figure jumps: the rest pose that motion capture
// begins with.
void DropRestPose(const std::vector<Joint>& joints, Clip* clip);

// Of a long recording the stretch of 0.6 to 2.5 s that comes back nearest to where it began while it moves on all the
// time: one cycle of a walk, without who stood before and after. False where none does well enough; the clip then stays
// whole.
bool CutToCycle(const std::vector<Joint>& joints, Clip* clip);

// The clip's first `duration_s` seconds.
void CutTo(float duration_s, size_t joints, Clip* clip);

}  // namespace flaneur
