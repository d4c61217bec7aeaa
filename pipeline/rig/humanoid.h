// Which joints of a skeleton are which part of a human body.
#pragma once
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/rig/bone_names.h"

namespace flaneur {

inline constexpr size_t kLeft = 0, kRight = 1;

struct HumanoidArm {
  int clavicle = -1, upper = -1, lower = -1, hand = -1;  // joints; -1: none
  std::array<std::vector<int>, 5> fingers;               // thumb to little finger, from the hand outwards
};

struct HumanoidLeg {
  int upper = -1, lower = -1, foot = -1, toes = -1;
};

struct Humanoid {
  int hips = -1;           // above both legs and the trunk
  std::vector<int> spine;  // above the hips, up to the chest, where the arms are
  std::vector<int> neck;
  int head = -1;
  std::array<HumanoidArm, 2> arms;
  std::array<HumanoidLeg, 2> legs;
  bool by_shape = false;    // not by the joints' names
  bool sides_known = true;  // else left and right may be the other way round
  bool quadruped = false;   // four legs: arms are the fore ones
  bool has_legs() const { return legs[kLeft].upper >= 0 && legs[kRight].upper >= 0; }
  bool has_arms() const { return arms[kLeft].upper >= 0 && arms[kRight].upper >= 0; }
};

// A joint that the file itself says is that part, as VRM does.
struct NamedBone {
  int joint = -1;
  BodyPart part = BodyPart::kNone;
  BodySide side = BodySide::kNone;
};

// By `told`, else by names, else by the skeleton's shape: two like chains are legs, two like chains above them arms.
// `positions`: of the joints in a pose without crossed limbs. Returns false, and says in `why` what is missing, where
// there are no two legs or nothing above them.
bool FindHumanoid(const std::vector<Joint>& joints, const std::vector<Vec3>& positions,
                  const std::vector<NamedBone>& told, Humanoid* humanoid, std::string* why);

// The person's own up and forward in these positions, unit and square to each other. False where they cannot be told.
bool FindStance(const Humanoid& humanoid, const std::vector<Vec3>& positions, Vec3* up, Vec3* forward);

}  // namespace flaneur
