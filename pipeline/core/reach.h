// How far a person reaches about the place where they stand.
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"

namespace flaneur {

// Metres on the ground, of every level and prop in every key of all clips. clip_of_prop: by prop the clip that it is a
// tool for, which alone it is looked at in; empty: it is no tool.
float Reach_m(const AvatarLevels& levels, const std::vector<std::string>& clip_of_prop = {});

}  // namespace flaneur
