#include "pipeline/rig/clip_rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kHangs = 0.93f;  // straight within 20 degrees of the trunk, or a little bent
constexpr float kAlike = 0.08f;  // of the leg's length, that one knee or foot may rest before or above the other

// 1: the leg is straight and goes on where the trunk ends; less: bent, or to a side. Legs of one bone are straight.
float Hang(const Humanoid& h, const Pose& pose, size_t side) {
  const HumanoidLeg& leg = h.legs[side];
  const int end = leg.foot >= 0 ? leg.foot : leg.lower;
  Vec3 up, forward;
  if (end < 0 || !FindStance(h, pose.positions, &up, &forward)) return 1;
  const Vec3 along = At(pose.positions, end) - At(pose.positions, leg.upper);
  const float length_m = leg.foot < 0 ? Length(along)
                                      : Length(At(pose.positions, leg.lower) - At(pose.positions, leg.upper)) +
                                            Length(At(pose.positions, leg.foot) - At(pose.positions, leg.lower));
  return length_m > 0 ? -Dot(along, up) / length_m : 1;
}

// The place in `values` of the greatest; the first of equals.
int IndexOfMost(const std::vector<float>& values) {
  return static_cast<int>(std::max_element(values.begin(), values.end()) - values.begin());
}

// The key that looks where the clip looks on the whole.
int KeyAhead(const Humanoid& h, const std::vector<Pose>& poses) {
  std::vector<Vec3> looks;
  Vec3 mean;
  for (const Pose& pose : poses) {
    Vec3 up, forward;
    if (!FindStance(h, pose.positions, &up, &forward)) forward = {};
    looks.push_back(forward);
    mean = mean + forward;
  }
  std::vector<float> ahead;
  for (const Vec3& look : looks) ahead.push_back(Dot(look, mean));
  return IndexOfMost(ahead);
}

void RestAsIn(const Clip& clip, const std::vector<int>& keys, std::vector<Joint>* joints) {
  std::vector<Mat4> world(joints->size());
  for (size_t j = 0; j < joints->size(); ++j) {
    Joint& joint = (*joints)[j];
    joint.rest = clip.transforms[static_cast<size_t>(keys[j]) * joints->size() + j];
    const Mat4 local = FromTranslationRotationScale(joint.rest.translation, joint.rest.rotation, joint.rest.scale);
    world[j] = joint.parent < 0 ? local : At(world, joint.parent) * local;
    joint.inverse_bind = Inverse(world[j]);
  }
}

void StandAtRest(const Humanoid& h, const Clip& clip, std::vector<Joint>* joints) {
  std::vector<Pose> poses;
  for (int k = 0; k < clip.keys; ++k)
    poses.push_back(PoseOf(*joints, clip.transforms.data() + static_cast<size_t>(k) * joints->size()));
  std::vector<int> keys(joints->size(), KeyAhead(h, poses));
  for (const size_t side : {kLeft, kRight}) {
    std::vector<float> hangs;
    for (const Pose& pose : poses) hangs.push_back(Hang(h, pose, side));
    const int best = IndexOfMost(hangs);
    for (size_t j = 0; j < joints->size(); ++j)
      if (IsBelow(*joints, static_cast<int>(j), h.legs[side].upper)) keys[j] = best;
  }
  RestAsIn(clip, keys, joints);
}

float Hang(const Humanoid& h, const Pose& pose) { return std::min(Hang(h, pose, kLeft), Hang(h, pose, kRight)); }

// How far one knee or foot is before or above the other, as a share of the leg.
float Unlike(const Humanoid& h, const Pose& pose) {
  Vec3 up, forward;
  if (!FindStance(h, pose.positions, &up, &forward)) return 0;
  const auto from_hip = [&](size_t side, int joint) {
    return At(pose.positions, joint) - At(pose.positions, h.legs[side].upper);
  };
  const HumanoidLeg &left = h.legs[kLeft], &right = h.legs[kRight];
  float most = 0, leg_m = 0;
  for (const auto& [a, b] : {std::pair{left.lower, right.lower}, {left.foot, right.foot}}) {
    if (a < 0 || b < 0) continue;
    const Vec3 off = from_hip(kLeft, a) - from_hip(kRight, b);
    most = std::max({most, std::abs(Dot(off, up)), std::abs(Dot(off, forward))});
    leg_m = std::max(leg_m, Length(from_hip(kLeft, a)));
  }
  return leg_m > 0 ? most / leg_m : 0;
}

bool Stands(const Humanoid& h, const Pose& pose) { return Hang(h, pose) > kHangs && Unlike(h, pose) < kAlike; }

bool HasArmsOfOneBone(const Humanoid& h) {
  return h.has_arms() && std::all_of(h.arms.begin(), h.arms.end(),
                                     [](const HumanoidArm& arm) { return arm.lower < 0 && arm.hand < 0; });
}

}  // namespace

bool MakeClipRig(const Avatar& skeleton, const std::vector<NamedBone>& told, const Clip& clip, Rig* rig,
                 std::string* why) {
  Humanoid h;
  Avatar bones;
  bones.joints = skeleton.joints;
  const Pose rest = BindPose(skeleton.joints);
  const bool known = FindHumanoid(skeleton.joints, rest.positions, told, &h, why) && !h.quadruped && h.has_legs();
  const bool stands = !known || Stands(h, rest);
  const bool has_figure = !skeleton.meshes.empty();
  if (!stands && !has_figure && clip.keys > 0) {
    StandAtRest(h, clip, &bones.joints);
    if (Hang(h, BindPose(bones.joints)) > Hang(h, rest)) return MakeRig(bones, told, rig, why);
    bones.joints = skeleton.joints;
  }
  if (known && (!stands || HasArmsOfOneBone(h))) bones.meshes = skeleton.meshes;
  return MakeRig(bones, told, rig, why);
}

}  // namespace flaneur
