// How people choose their velocity: towards the goal, around others, off walls.
#pragma once
#include <vector>

#include "runtime/crowd/crowd.h"

namespace flaneur {

// Speed in a crowd over speed alone, by the density around (Weidmann 1993).
float SpeedInDensity(float density_pm2);

// Fills crowd->wanted with the velocities of this step, and crowd->contacts with the pairs that could touch in it.
// crowd->neighbours holds everybody who takes care.
void ChooseVelocities(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, Crowd* crowd);

}  // namespace flaneur
