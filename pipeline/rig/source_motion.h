// A clip of one person as it is taken over to another's skeleton: upright, on the ground, on the spot and closed.
#pragma once
#include <array>
#include <vector>

#include "pipeline/core/rotation.h"
#include "pipeline/rig/rig.h"
#include "pipeline/rig/steps.h"
#include "runtime/base/array.h"

namespace flaneur {

// The source's motion by body part, free of any skeleton; lengths in source units, upright, on the spot or travelling.
struct Motion {
  float step_s = 1.0f / 30;
  bool loops = true;
  std::vector<Pose> poses;
  float speed = 0;  // source units a second along +Z, already taken out of the poses
};

// Which of its feet stand, and when, besides.
class SourceMotion {
 public:
  SourceMotion(const Rig& rig, const Clip& clip, bool walks);

  const Motion& motion() const { return motion_; }
  const std::vector<bool>& stands(size_t side) const { return stands_[side]; }
  float slide() const { return slide_; }
  bool stiff() const { return walks_ && !BendsKnees(rig_); }

  // How far the joint has turned from its reference.
  Quat Turned(size_t key, int joint) const {
    return Product(At(motion_.poses[key].rotations, joint), Conjugate(At(rig_.reference.rotations, joint)));
  }

  Vec3 Place(size_t key, int joint) const { return At(motion_.poses[key].positions, joint); }
  Vec3 Ankle(size_t key, size_t side) const { return PlaceOf(rig_.legs[side].ankle, motion_.poses[key]); }
  // By how much the hips would be lower, a key, if all feet that stand stood on the ground.
  std::vector<float> Sinks() const;

  Vec3 Middle(size_t key) const {
    return (Place(key, rig_.legs[kLeft].upper) + Place(key, rig_.legs[kRight].upper)) * 0.5f;
  }

 private:
  // By quarters about the level axes, so that who bends or sits is not straightened; fully about the vertical.
  void StandUp();
  void TakeTravel();
  float Gap(const Pose& a, const Pose& b) const;
  // The last pose becomes the first: it nearly is, or just one more is missing, or the end is led over into it.
  void CloseLoop();
  static void Shift(Vec3 by, Pose* pose);
  Soles SolesOf(size_t side) const;
  void PutOnGround();
  void FindSpeed();
  void FindSteps();
  // Both legs of one bone pass the ground at one height: that which goes back stands.
  void FindStiffSteps();

  const Rig& rig_;
  bool walks_;
  float slide_ = 0;
  Motion motion_;
  std::array<std::vector<bool>, 2> stands_;
};

}  // namespace flaneur
