// A human skeleton known by its shape alone, where names say nothing.
#pragma once
#include <vector>

#include "pipeline/rig/humanoid.h"

namespace flaneur {

// Fills limbs, head and `sides_known`; what lies between the limbs is left to FindHumanoid. False where there are no
// two pairs of like chains, one above the other; beside each other they can be a quadruped's alone, and `quadruped` is
// set.
bool FindHumanoidByShape(const std::vector<Joint>& joints, const std::vector<Vec3>& positions, Humanoid* humanoid);

}  // namespace flaneur
