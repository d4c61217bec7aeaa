// Skeletons of more joints than the player knows, made smaller where nobody sees it.
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"

namespace flaneur {

// Lets joints follow their parents, those first that move nothing otherwise, until no more than `most` are left: facial
// rigs, every bone of a braid. Says in a warning how many went and what that moves at most. False where even 5 cm do
// not do.
bool LimitJoints(int most, Avatar* avatar, std::vector<std::string>* warnings);

}  // namespace flaneur
