// What a bone's name says, in the words of Mixamo, VRM, Rigify, MakeHuman, Unreal, Unity, Biped, HumanIK, Poser, CMU,
// Quaternius, KayKit, MikuMikuDance and their like.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace flaneur {

enum class BodyPart : uint8_t {
  kNone,
  kHips,
  kSpine,
  kNeck,
  kHead,
  kClavicle,
  kShoulder,  // a collar bone to some, the upper arm to others
  kUpperArm,
  kArm,  // the upper arm, where a lower one has a name of its own
  kLowerArm,
  kHand,
  kUpperLeg,
  kLeg,  // the lower leg, where the upper one has a name of its own
  kLowerLeg,
  kFoot,
  kToes,
  kThumb,
  kIndex,
  kMiddle,
  kRing,
  kLittle,
  kFinger,  // one of them, by its number
};

enum class BodySide : uint8_t { kNone, kLeft, kRight };

struct BoneName {
  BodyPart part = BodyPart::kNone;
  BodySide side = BodySide::kNone;
  int number = -1;  // the first digits in it that are no prefix's, -1: none
};

// kNone for what is no part of a body: twist, control and end bones, hair, clothes, things carried.
BoneName ReadBoneName(const std::string& name);

// Of all bones of a rig, without what most of their names begin with: "Gandalf_L_Thigh", "old_man_Head". Empty where
// they share nothing.
std::vector<BoneName> ReadWithoutOwner(const std::vector<std::string>& names);

}  // namespace flaneur
