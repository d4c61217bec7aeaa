// What a morph target's name says, in the words of ARKit, VRM, VRoid, VRChat, Ready Player Me, Oculus, Character
// Creator, Daz, Mixamo, MakeHuman and MikuMikuDance.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "pipeline/rig/bone_names.h"

namespace flaneur {

enum class FaceMove : uint8_t { kBlink, kOpenMouth, kNone };
inline constexpr size_t kFaceMoves = 2;

struct FaceName {
  FaceMove move = FaceMove::kNone;
  BodySide side = BodySide::kNone;  // kNone: of both eyes
  int rank = 0;                     // of several names for one movement the least is taken
};

FaceName ReadFaceName(const std::string& name);

}  // namespace flaneur
