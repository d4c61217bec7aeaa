// What the simulation looks like now.
#pragma once
#include "runtime/pack/tour_pack.h"
#include "runtime/player/simulation.h"
#include "runtime/render/frame.h"

namespace flaneur {

void FrameFromSimulation(const TourPack& pack, const Simulation& simulation, FrameInput* frame);

}  // namespace flaneur
