// The hour of a tour's day.
#pragma once
#include "runtime/simulation/simulation.h"

namespace flaneur {

// By the sun, 0 to 24: 12 where it stands in the south.
float HourOfSun(Vec3 to_sun);
// 0 to 24: the simulation's own, else by where the sun stands.
float HourNow(const Simulation& simulation, Vec3 to_sun);

}  // namespace flaneur
