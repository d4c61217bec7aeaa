#include "pipeline/rig/still_legs.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kStill = 0.125f;  // of the leg's length; who strolls moves each ankle by half of it
constexpr float kLies = 0.5f;     // of a thigh's length: how far the knee of who sits is below the hip at most

}  // namespace

bool KeepsLegsStill(const Rig& rig, const Clip& clip) {
  for (const RigLeg& leg : rig.legs) {
    Vec3 low{1e30f, 1e30f, 1e30f}, high = low * -1;
    for (int k = 0; k < clip.keys; ++k) {
      const Pose pose = PoseAt(rig, clip, k);
      const Vec3 ankle = PlaceOf(leg.ankle, pose) - At(pose.positions, leg.upper);
      low = {std::min(low.x, ankle.x), std::min(low.y, ankle.y), std::min(low.z, ankle.z)};
      high = {std::max(high.x, ankle.x), std::max(high.y, ankle.y), std::max(high.z, ankle.z)};
    }
    if (Length(high - low) > kStill * rig.leg_m) return false;
  }
  return true;
}

bool Sits(const Rig& rig, const Clip& clip) {
  if (!BendsKnees(rig) || clip.keys < 1) return false;
  const Pose pose = PoseAt(rig, clip, 0);
  const bool lie = std::all_of(rig.legs.begin(), rig.legs.end(), [&](const RigLeg& leg) {
    const Vec3 thigh = At(pose.positions, leg.upper) - At(pose.positions, leg.lower);
    return thigh.y < kLies * Length(thigh);
  });
  return lie && KeepsLegsStill(rig, clip);
}

void KeepSeated(const Rig& rig, const Clip& seated, Clip* clip) {
  const size_t joints = rig.joints.size();
  std::vector<bool> kept(joints, false);
  for (int a = rig.humanoid.hips; a >= 0; a = At(rig.joints, a).parent) At(kept, a) = true;
  for (const RigLeg& leg : rig.legs) At(kept, leg.upper) = true;
  for (size_t j = 0; j < joints; ++j) {
    for (int a = rig.joints[j].parent; a >= 0 && !kept[j]; a = At(rig.joints, a).parent) {
      kept[j] = a == rig.legs[kLeft].upper || a == rig.legs[kRight].upper;
    }
  }
  for (size_t i = 0; i < clip->transforms.size(); ++i) {
    if (kept[i % joints]) clip->transforms[i] = seated.transforms[i % joints];
  }
}

}  // namespace flaneur
