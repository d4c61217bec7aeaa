// Children at play: they run between points of a place, stand for breath, and run on. Internal to runtime/town.
#pragma once
#include "runtime/town/town.h"

namespace flaneur {

// Puts those of every place of play there, up to `wanted`; how many they are.
int PlacePlayers(int wanted, Town* town);

void StepPlay(const Viewer& viewer, Town* town);

// Of whoever plays, at most; 0 where nobody does.
float FastestPlay_mps(const Town& town);

}  // namespace flaneur
