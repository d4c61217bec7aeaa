// How far the town's turning parts have turned at a moment. Nothing is remembered: the same moment turns them alike.
// Internal to runtime/show.
#pragma once
#include "runtime/pack/tour_pack.h"
#include "runtime/render/frame.h"

namespace flaneur {

// hour: of the day, 0 to 24. Without wind a weathercock stays as it is modelled.
void TurnParts(const TourPack& pack, float time_s, float hour, FrameInput* frame);

}  // namespace flaneur
