// People at work: a keeper behind a stall, somebody who sweeps, sits or draws water. Internal to runtime/town.
#pragma once
#include "runtime/town/town.h"

namespace flaneur {

inline constexpr float kLeastWorkRoom_m = 0.2f;  // to obstacles: a place of work with less is moved to free ground

// From p to the nearest obstacle; 0 inside one.
float RoomAt_m(const Walkable& walkable, Vec2 p);

// A spot for each place of work that somebody can do.
void PrepareWork(Town* town);

// Puts people to work, as many as CrowdSettings::work_share of `wanted` allows; how many they are.
int PlaceWorkers(int wanted, const Viewer& viewer, Town* town);

// The person's spot is free again.
void StopWork(size_t person, Town* town);

// For everybody: who has come to their place begins; who is pushed aside comes back; whose time is over leaves, and
// after a while somebody else who strolls near takes the place.
void StepWork(const Viewer& viewer, Town* town);

}  // namespace flaneur
