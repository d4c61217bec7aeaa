// How far a person reaches about the place where they stand.
#pragma once
#include "pipeline/core/avatar.h"

namespace flaneur {

// Metres on the ground, of every level and prop in every key of the clips that people play.
float Reach_m(const AvatarLevels& levels);

}  // namespace flaneur
