// A human skeleton in the pose that all others are reckoned from: upright, facing +Z, soles at y = 0, any unit.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/rig/humanoid.h"

namespace flaneur {

// World positions and rotations, one a joint.
struct Pose {
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
};

// Of joints, parents first, whose local transforms these are.
Pose PoseOf(const std::vector<Joint>& joints, const Transform* transforms);

// That of the inverse bind matrices.
Pose BindPose(const std::vector<Joint>& joints);

// Turns all of it about the origin.
void TurnPose(Quat turn, Pose* pose);

// A point that moves with a joint, in the joint's own frame.
struct JointPoint {
  int joint = -1;
  Vec3 offset;
};
Vec3 PlaceOf(const JointPoint& point, const Pose& pose);

// A point of a sole: it moves with the foot, and in part with toes and shin.
struct SolePoint {
  JointPoint foot, toes, shin;
  float toes_weight = 0, shin_weight = 0;  // 0: the joint is not set
};
Vec3 PlaceOf(const SolePoint& point, const Pose& pose);

// One leg with all that a step needs. `lower`, `foot` and `toes` are -1 where the rig has none.
struct RigLeg {
  int upper = -1, lower = -1, foot = -1, toes = -1;
  JointPoint ankle;               // the foot's joint, or where it would be
  float thigh_m = 0, shin_m = 0;  // shin_m 0: the leg is one bone
  float ankle_height_m = 0;       // above the sole's lowest point
  std::vector<SolePoint> sole;
  std::vector<SolePoint> tips;  // of the foot, that come lowest where it is pitched far: a boot's cap, its heel's back
};

inline constexpr float kStraightest = 0.998f;  // of a leg's length: a knee never stretches further

// How high a hip may be above its ankle, which is so far away on the level.
float HighestHip(const RigLeg& leg, Vec3 off);

// Directions and turns of one arm in the reference pose. A limb's frame is the turn that brings the like limb of a
// person in T-pose, palms down, to it.
struct RigArm {
  Quat upper, lower, hand;
};

struct Rig {
  std::vector<Joint> joints;
  Humanoid humanoid;
  Quat turn;   // from the joints' own space to the reference pose's
  Vec3 shift;  // added after it
  Pose reference;
  std::array<RigLeg, 2> legs;
  std::array<Quat, 2> leg_upper, leg_lower;  // frames as RigArm's, of a leg that hangs straight down
  std::array<RigArm, 2> arms;
  float leg_m = 0;  // thigh and shin
};

// Of one key of a clip on the rig's joints in their own space, turned as the reference pose is.
Pose PoseAt(const Rig& rig, const Clip& clip, int key);

// The mean over a clip of the humanoid's own up and forward. False where its poses differ too much to tell.
bool FindStance(const Humanoid& humanoid, const std::vector<Joint>& joints, const Clip& clip, Vec3* up, Vec3* forward);

// A body's turn over a walk, to one side at most.
inline constexpr float kSways_rad = 0.4f;

// From where the rig's bind pose faces to where the clip does, about the vertical and in the joints' own space; none
// where it is no more than a body sways.
Quat HeadingOf(const Rig& rig, const Clip& clip);

// Else legs are one bone each, and who walks on them floats or bobs.
bool BendsKnees(const Rig& rig);

// `person`: with meshes, whose soles are then known, or without. False where it is no human skeleton; `why` says what
// is missing.
bool MakeRig(const Avatar& person, const std::vector<NamedBone>& told, Rig* rig, std::string* why);

// Of the 24 turns by quarters the one that brings `up` and `forward` nearest to +Y and +Z.
Quat QuarterTurn(Vec3 up, Vec3 forward);

// By less than 10 degrees a body may be turned that walks straight on; a figure that is turned by more stands at an odd
// angle.
inline constexpr float kOddAngle_rad = 0.17f;

// The same, and about the vertical by what is left, where that is more than `least_rad`.
Quat TurnToFront(Vec3 up, Vec3 forward, float least_rad = kOddAngle_rad);

// The limb's frame: -Y along it and +Z as near to `front` as can be.
Quat LegFrame(Vec3 along, Vec3 front);

}  // namespace flaneur
