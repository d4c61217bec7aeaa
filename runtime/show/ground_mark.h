// A ring on the ground where the visitor is on the way to. Internal to runtime/show.
#pragma once
#include <vector>

#include "runtime/simulation/simulation.h"

namespace flaneur {

// A strip of triangles over the ground, in ground axes; empty while the visitor is not walking to a place pointed at.
void RingWherePointed(const Simulation& simulation, std::vector<Vec3>* strip);

}  // namespace flaneur
