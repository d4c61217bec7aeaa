// Whose shadows people's triangle budget affords.
#pragma once
#include <cstdint>
#include <vector>

#include "runtime/tour_data/shadow_limits.h"

namespace flaneur {

// The most triangles of the two figures.
struct ShadowCost {
  int fine_triangles = 0, coarse_triangles = 0;
};

// Somebody in view. Who has no cost casts no shadow.
struct ShadowCaster {
  float distance_m = 0;
  ShadowCost cost;
};

struct Shadows {
  float fine_m = kFineShadow_m, reach_m = kShadowReach_m;  // in force
  int64_t triangles = 0;                                   // of all shadows within them
  std::vector<ShadowCaster> casters;                       // of this step, to be set before ChooseShadows
  std::vector<int64_t> by_distance;                        // scratch: triangles by steps of distance
};

// Moves both distances so that all shadows together take at most `room_triangles`: at once where they would take more,
// slowly where they take less, so that shadows do not come and go. Everybody's coarse shadow goes before anybody's fine
// one.
void ChooseShadows(int64_t room_triangles, float step_s, Shadows* state);

}  // namespace flaneur
