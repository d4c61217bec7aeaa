// Who lives in the town, and where everybody starts. Internal to runtime/town.
#pragma once
#include "runtime/base/error.h"
#include "runtime/town/town.h"

namespace flaneur {

Error PlaceScenarioPeople(const std::vector<ScenarioPerson>& persons, Town* town);
// Spreads so many of the pack's own people over the walkable ground, each with somewhere to go.
void PlaceCrowd(int people, const Viewer& viewer, Town* town);

// How many come along: 1, or 2 to 4 who are a group. At most `most`.
int DrawCompany(int most, Town* town);
// Somebody of the pack's crowd; where and where to is still open.
Person NewPerson(Town* town);
Person NewPersonOf(int avatar, Town* town);
// The person lives in the town from now on.
void AddToTown(Person person, PersonPlan plan, Town* town);

}  // namespace flaneur
