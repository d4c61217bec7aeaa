// Who lives in the town: where people start, where they go, how they leave and others come. Internal to runtime/player.
#pragma once
#include "runtime/player/simulation.h"

namespace flaneur {

// A cell of the largest connected walkable area, -1 where there is none.
int BestFreeCell(const Walkable& walkable);

Error PlaceScenarioPeople(const Scenario& scenario, Simulation* simulation);
// Spreads the pack's own people over the walkable ground, each with somewhere to go.
void PlaceCrowd(Simulation* simulation);
// People who arrived go on, stand a while or leave; others come through doors and exits that are out of sight.
void LeaveAndArrive(Simulation* simulation);

}  // namespace flaneur
