// Nobody walks into anybody: pairs that would touch in a step share the correction.
#pragma once
#include <vector>

#include "runtime/crowd/crowd.h"

namespace flaneur {

// Where person i gets who heads for `to`: off walls, out of discs that are for everyone, no farther than walking
// allows.
Vec2 WalkTowards(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, const Crowd& c, size_t i,
                 Vec2 to);

// Fills scratch->contacts with the pairs of scratch->neighbours that could touch in this step.
void FindContacts(const Crowd& crowd, float step_s, Jobs* jobs, CrowdScratch* scratch);

// Corrects scratch->moved (as in Weiss et al. 2019, position-based crowds), within what walking allows.
void ResolveContacts(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, const Crowd& crowd,
                     CrowdScratch* scratch);

}  // namespace flaneur
