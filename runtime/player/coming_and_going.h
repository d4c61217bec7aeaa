// What people do when they get somewhere, and who leaves and comes. Internal to runtime/player.
#pragma once
#include "runtime/player/simulation.h"

namespace flaneur {

// People who arrived go on, stand a while or leave; others come through doors and exits that are out of sight.
void LeaveAndArrive(Simulation* simulation);

}  // namespace flaneur
