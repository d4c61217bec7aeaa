// A visitor as anybody might be, drawn from a seed. Internal to runtime/walk.
#pragma once
#include "runtime/walk/visitor.h"

namespace flaneur {

// Nobody who wanders is faster, or turns faster.
inline constexpr float kWanderMost_mps = 3.5f, kWanderMost_dps = 120;

// What such a visitor does next: strolls or hurries somewhere in sight, looks where they go, aside or back meanwhile,
// stands, looks about, turns or follows somebody.
CameraLeg DrawLeg(const VisitorInTown& v, Random* random);

}  // namespace flaneur
