// Who lives in the town, and where everybody starts. Internal to runtime/player.
#pragma once
#include "runtime/player/simulation.h"

namespace flaneur {

Error PlaceScenarioPeople(const Scenario& scenario, Simulation* simulation);
// Spreads the pack's own people over the walkable ground, each with somewhere to go.
void PlaceCrowd(Simulation* simulation);

// How many come along: 1, or 2 to 4 who are a group. At most `most`.
int DrawCompany(int most, Simulation* simulation);
// Somebody of the pack's crowd; where and where to is still open.
Person NewPerson(Simulation* simulation);
// The person lives in the town from now on.
void AddToTown(const Person& person, PersonPlan plan, Simulation* simulation);

}  // namespace flaneur
