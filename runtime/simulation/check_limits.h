// What cannot be played, named before it begins. Internal to runtime/simulation.
#pragma once
#include "runtime/simulation/simulation.h"

namespace flaneur {

// Errors: radii of which one must lie within the other and doesn't; a crowd_area without walkable ground. Warns where
// the triangle budget cannot hold high_limit people.
Error CheckLimits(Simulation* simulation);

}  // namespace flaneur
