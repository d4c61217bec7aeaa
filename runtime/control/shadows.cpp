#include "runtime/control/shadows.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

constexpr float kStep_m = 0.5f;  // of the distances
constexpr float kRise_mps = 1.0f;

// The farthest multiple of kStep_m up to `most_m` within which `cost_of` all casters adds up to `room`; what it adds up
// to in `spent`.
float FarthestWithin_m(float most_m, int64_t room, auto cost_of, Shadows* s, int64_t* spent) {
  s->by_distance.assign(static_cast<size_t>(std::ceil(most_m / kStep_m)), 0);
  for (const ShadowCaster& caster : s->casters) {
    if (caster.distance_m < most_m) s->by_distance[static_cast<size_t>(caster.distance_m / kStep_m)] += cost_of(caster);
  }
  *spent = 0;
  for (size_t k = 0; k < s->by_distance.size(); ++k) {
    if (*spent + s->by_distance[k] > room) return static_cast<float>(k) * kStep_m;
    *spent += s->by_distance[k];
  }
  return most_m;
}

}  // namespace

void ChooseShadows(int64_t room_triangles, float step_s, Shadows* state) {
  const float rise_m = kRise_mps * step_s;
  int64_t coarse = 0, finer = 0;
  state->reach_m = FarthestWithin_m(
      std::min(kShadowReach_m, state->reach_m + rise_m), room_triangles,
      [](const ShadowCaster& c) { return int64_t{c.cost.coarse_triangles} * (c.distance_m < kTwoShadows_m ? 2 : 1); },
      state, &coarse);
  state->fine_m = FarthestWithin_m(
      std::min({kFineShadow_m, state->fine_m + rise_m, state->reach_m}), room_triangles - coarse,
      [](const ShadowCaster& c) { return int64_t{std::max(0, c.cost.fine_triangles - c.cost.coarse_triangles)}; },
      state, &finer);
  state->triangles = coarse + finer;
}

}  // namespace flaneur
