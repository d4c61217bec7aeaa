// What people do when they get somewhere, and who leaves and comes. Internal to runtime/town.
#pragma once
#include "runtime/town/town.h"

namespace flaneur {

// People who arrived go on, stand a while or leave; others come through doors and exits that are out of sight.
void LeaveAndArrive(const Viewer& viewer, Town* town);

}  // namespace flaneur
