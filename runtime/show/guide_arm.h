// The arm with which the guide carries the banner, whatever skeleton the figure has. Internal to runtime/show.
#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "runtime/pack/tour_pack.h"

namespace flaneur {

// The right one, bent so that the hand is before the body, the thumb above and the fingers closed. Places in avatar
// axes (x to the left, y up, z ahead) as they are while the trunk rests.
struct CarryingArm {
  int trunk = -1, shoulder = -1, elbow = -1, hand = -1;  // joints
  std::vector<std::pair<int, Mat4>> bent;                // all the arm's joints: from the rest pose to the bent arm
  Mat4 hand_bent;                                        // of them the hand's
  Vec3 grip_m;                                           // what the hand is closed round
};

Quat About(Vec3 axis, float angle_rad);

// What is at `from` comes to `to`, turned about there.
Mat4 Carried(Vec3 from, Vec3 to, Quat turn);

// By the joints' names and places; none where nothing there looks like a right arm.
std::optional<CarryingArm> FindCarryingArm(const std::vector<PackJoint>& skeleton, float height_m);

// The arm keeps to the trunk in every clip.
void CarryInClips(const CarryingArm& arm, PackAvatar* figure);

}  // namespace flaneur
