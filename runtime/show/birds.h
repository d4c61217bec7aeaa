// The simulation's birds as a picture shows them. Internal to runtime/show.
#pragma once
#include "runtime/render/frame.h"
#include "runtime/simulation/simulation.h"

namespace flaneur {

// share: of a step's time that has passed since the last one.
void AddBirds(const TourPack& pack, const Simulation& simulation, float share, FrameInput* frame);

}  // namespace flaneur
