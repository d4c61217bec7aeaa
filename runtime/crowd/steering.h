// How people choose their velocity: towards the goal, around others, off walls.
#pragma once
#include <vector>

#include "runtime/crowd/constants.h"
#include "runtime/crowd/crowd.h"

namespace flaneur {

// Speed in a crowd over speed alone, by the density around (Weidmann 1993).
float SpeedInDensity(float density_pm2);

// Speed in this cell of the ground (-1: off it): slower uphill and down.
float SpeedOnSlope(const Walkable& w, int cell, float level_mps);

// Those of the neighbours whose turn it is renew what they ask for: the push, the speed and the clearance in
// crowd->mind.
void Decide(const Walkable& w, const std::vector<MovingObstacle>& moving, const NeighbourGrid& neighbours, float step_s,
            Jobs* jobs, Crowd* crowd);

// Of who works: to their post, where they are not there.
Vec2 ToPost_mps(size_t i, const Crowd& crowd);

// Fills crowd->wanted[i] from what the person asks for.
void ChooseVelocity(float step_s, size_t i, Crowd* crowd);

}  // namespace flaneur
