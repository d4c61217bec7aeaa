#include "pipeline/rig/source_motion.h"

#include <algorithm>
#include <cmath>

#include "pipeline/core/rotation.h"
#include "runtime/base/array.h"

namespace flaneur {

SourceMotion::SourceMotion(const Rig& rig, const Clip& clip, bool walks) : rig_(rig), walks_(walks) {
  const size_t joints = rig.joints.size();
  motion_.step_s = clip.keys > 1 ? clip.duration_s / static_cast<float>(clip.keys - 1) : 1.0f / 30;
  for (int k = 0; k < clip.keys; ++k) {
    motion_.poses.push_back(PoseOf(rig.joints, clip.transforms.data() + static_cast<size_t>(k) * joints));
  }
  StandUp();
  TakeTravel();
  CloseLoop();
  PutOnGround();
  FindSpeed();
}

std::vector<float> SourceMotion::Sinks() const {
  std::vector<float> lower(motion_.poses.size(), 0.0f);
  for (size_t k = 0; k < lower.size(); ++k) {
    for (const size_t side : {kLeft, kRight}) {
      if (!stands_[side][k]) continue;
      const RigLeg& leg = rig_.legs[side];
      float low = 1e30f;
      for (const SolePoint& point : leg.sole) low = std::min(low, PlaceOf(point, motion_.poses[k]).y);
      const Vec3 off = Place(k, leg.upper) - Ankle(k, side);
      lower[k] = std::max(lower[k], off.y + low - HighestHip(leg, off));
    }
  }
  return lower;
}

void SourceMotion::StandUp() {
  Vec3 up, forward;
  for (const Pose& pose : motion_.poses) {
    Vec3 u, f;
    if (!FindStance(rig_.humanoid, pose.positions, &u, &f)) continue;
    up = up + u, forward = forward + f;
  }
  const Quat turn = TurnToFront(Normalized(up), Normalized(forward), 0);
  for (Pose& pose : motion_.poses) TurnPose(turn, &pose);
}

void SourceMotion::TakeTravel() {
  const size_t last = motion_.poses.size() - 1;
  if (last == 0) return;
  Vec3 travel = Middle(last) - Middle(0);
  travel.y = 0;
  if (Length(travel) > 0.15f * rig_.leg_m * static_cast<float>(last) * motion_.step_s) {
    const Quat ahead = TurnAbout({0, 1, 0}, -std::atan2(travel.x, travel.z));
    if (std::abs(std::atan2(travel.x, travel.z)) < 0.8f) {  // else it goes sideways or backwards, and is let
      for (Pose& pose : motion_.poses) TurnPose(ahead, &pose);
      travel = Rotated(ahead, travel);
    }
    motion_.speed = travel.z / (static_cast<float>(last) * motion_.step_s);
  } else {
    travel = {};
  }
  Vec3 mean;
  for (size_t k = 0; k <= last; ++k) {
    const float share = static_cast<float>(k) / static_cast<float>(last);
    Shift(travel * -share, &motion_.poses[k]);
    mean = mean + Middle(k) * (1 / static_cast<float>(last + 1));
  }
  for (Pose& pose : motion_.poses) Shift({-mean.x, 0, -mean.z}, &pose);
}

float SourceMotion::Gap(const Pose& a, const Pose& b) const {
  float sum = 0;
  for (size_t j = 0; j < rig_.joints.size(); ++j) sum += Length(a.positions[j] - b.positions[j]);
  return sum / static_cast<float>(rig_.joints.size());
}

void SourceMotion::CloseLoop() {
  auto& poses = motion_.poses;
  if (poses.size() < 3) return;
  float step = 0;
  for (size_t k = 1; k < poses.size(); ++k) step += Gap(poses[k - 1], poses[k]) / static_cast<float>(poses.size() - 1);
  const float gap = Gap(poses.front(), poses.back());
  if (gap > 0.5f * step && gap <= 2 * step) {
    poses.push_back(poses.front());
  } else if (gap > 2 * step) {
    const size_t blended = std::max<size_t>(1, poses.size() / 4);
    for (size_t i = 0; i < blended; ++i) {
      Pose& pose = poses[poses.size() - blended + i];
      const float t = static_cast<float>(i + 1) / static_cast<float>(blended);
      const float share = t * t * (3 - 2 * t);
      for (size_t j = 0; j < rig_.joints.size(); ++j) {
        pose.positions[j] = pose.positions[j] * (1 - share) + poses.front().positions[j] * share;
        pose.rotations[j] = Slerp(pose.rotations[j], poses.front().rotations[j], share);
      }
    }
  }
  poses.back() = poses.front();
}

void SourceMotion::Shift(Vec3 by, Pose* pose) {
  for (Vec3& p : pose->positions) p = p + by;
}

Soles SourceMotion::SolesOf(size_t side) const {
  Soles soles;
  for (const Pose& pose : motion_.poses) {
    std::vector<Vec3>& points = soles.emplace_back();
    for (const SolePoint& point : rig_.legs[side].sole) points.push_back(PlaceOf(point, pose));
  }
  return soles;
}

void SourceMotion::PutOnGround() {
  std::vector<float> lowest;
  for (const Pose& pose : motion_.poses) {
    float low = 1e30f;
    for (const RigLeg& leg : rig_.legs) {
      for (const SolePoint& point : leg.sole) low = std::min(low, PlaceOf(point, pose).y);
    }
    lowest.push_back(low);
  }
  // Legs of one bone cannot bend, so clips for them hop; walking, each pose stands.
  const float ground = GroundUnder(lowest, rig_.leg_m, walks_);
  for (size_t k = 0; k < lowest.size(); ++k) Shift({0, stiff() ? -lowest[k] : -ground, 0}, &motion_.poses[k]);
}

void SourceMotion::FindSpeed() {
  motion_.loops = motion_.poses.size() > 2;
  if (stiff()) FindStiffSteps();
  else FindSteps();
  for (std::vector<bool>& stands : stands_) {
    if (motion_.loops) stands.push_back(stands.front());  // the last key is the first
  }
}

void SourceMotion::FindSteps() {
  const auto left = SolesOf(kLeft), right = SolesOf(kRight);
  if (motion_.speed == 0) motion_.speed = SpeedOfSoles(left, right, motion_.step_s, rig_.leg_m);
  std::array<Soles, 2> soles{left, right};
  for (const size_t side : {kLeft, kRight}) {
    if (motion_.loops) soles[side].pop_back();
    stands_[side] = FindStance(soles[side], motion_.speed, motion_.step_s, rig_.leg_m, motion_.loops);
  }
  slide_ = SlideOfSoles(left, right, motion_.step_s, rig_.leg_m, motion_.speed);
  StandSomewhere(soles[kLeft], soles[kRight], rig_.leg_m, walks_ && motion_.speed != 0, &stands_[kLeft],
                 &stands_[kRight]);
}

void SourceMotion::FindStiffSteps() {
  float way = 0, keys = 0;
  for (size_t k = 0; k + 1 < motion_.poses.size(); ++k) {
    for (const size_t side : {kLeft, kRight}) {
      const float back = Ankle(k, side).z - Ankle(k + 1, side).z;
      const float other = Ankle(k, 1 - side).z - Ankle(k + 1, 1 - side).z;
      stands_[side].push_back(back >= other);
      if (back >= other) way += back, keys += 1;
    }
  }
  if (motion_.speed == 0 && keys > 0) motion_.speed = way / (keys * motion_.step_s);
  if (!motion_.loops) stands_[kLeft].push_back(true), stands_[kRight].push_back(true);
  const Soles level(stands_[kLeft].size(), {Vec3{}});
  StandSomewhere(level, level, rig_.leg_m, true, &stands_[kLeft], &stands_[kRight]);
}

}  // namespace flaneur
