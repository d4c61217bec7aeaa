// Smoke over chimneys as it is at a moment. Nothing is remembered: the same moment gives the same smoke.
// Internal to runtime/show.
#pragma once
#include "runtime/render/frame.h"
#include "runtime/tour_data/tour_data.h"

namespace flaneur {

inline constexpr float kSmokeReach_m = 140;  // from the eye; farther smoke is not drawn,
inline constexpr int kPuffs = 24;            // of a chimney at a time
inline constexpr size_t kMostSmokes = 32;    // nor more than those of the nearest chimneys

// Of the chimneys about frame->eye, farthest puffs first.
void AddSmoke(const TourData& tour, float time_s, FrameInput* frame);

}  // namespace flaneur
