#include "runtime/control/level_control.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

constexpr float kBoundarySpeed_mps = 2.0f;   // r_high moves no faster than people walk
constexpr float kHysteresis_m = 0.8f;        // a mesh stays one until this far beyond r_high
constexpr float kStretch = 1.5f;             // in a sparse crowd r_high grows to this times its nominal value
constexpr float kBudgetGain = 0.02f;         // a step, of the budget's relative error (method 2)
constexpr float kFastCamera_mps = 2.0f;      // above it fidelity may fall (paper, section 3.2)

float PixelsHigh(float height_m, float distance_m, const ViewCamera& camera, int screen_width_px) {
  const float focal_px = static_cast<float>(screen_width_px) / (2 * std::tan(camera.fov_rad / 2));
  return height_m * focal_px / std::max(distance_m, 0.1f);
}

void FollowFrameTime(float frame_ms, float camera_speed_mps, const LevelSettings& s, LevelState* state) {
  if (state->budget_triangles <= 0) state->budget_triangles = static_cast<float>(s.budget_triangles);
  if (!s.by_frame_time || frame_ms <= 0) {
    state->budget_triangles = static_cast<float>(s.budget_triangles);
    return;
  }
  const float target_ms = camera_speed_mps > kFastCamera_mps ? s.target_ms * 0.85f : s.target_ms;
  const float error = std::clamp((target_ms - frame_ms) / target_ms, -1.0f, 1.0f);
  state->budget_triangles = std::clamp(state->budget_triangles * (1 + kBudgetGain * error), 1000.0f,
                                       static_cast<float>(s.budget_triangles));
}

// People's indices sorted by id, so that last step's level can be found where indices have moved.
int LastLevel(const LevelState& state, size_t index, int id) {
  if (index < state.id.size() && state.id[index] == id) return state.last_level[index];
  for (size_t i = 0; i < state.id.size(); ++i) {
    if (state.id[i] == id) return state.last_level[i];
  }
  return kNotDrawn;
}

int WantedLevel(const AvatarCosts& avatar, float px) {
  for (size_t k = 0; k + 1 < avatar.levels.size(); ++k) {
    if (px >= avatar.levels[k].switch_px) return static_cast<int>(k);
  }
  return static_cast<int>(avatar.levels.size()) - 1;
}

}  // namespace

void ChooseLevels(const Crowd& crowd, const std::vector<AvatarCosts>& avatars, const ViewCamera& camera,
                  float camera_speed_mps, float frame_ms, const LevelSettings& s, float step_s, LevelState* state) {
  FollowFrameTime(frame_ms, camera_speed_mps, s, state);
  if (state->r_high_m <= 0) state->r_high_m = s.r_high_m;
  const int limit = s.by_frame_time ? static_cast<int>(crowd.size()) : s.high_limit;

  state->last_level = state->level;
  state->level.assign(crowd.size(), kNotDrawn);
  state->order.clear();
  const auto distance = [&](int i) { return Length(crowd.position[static_cast<size_t>(i)] - camera.position); };
  for (size_t i = 0; i < crowd.size(); ++i) {
    if (crowd.view[i] == ViewClass::kVisible && distance(static_cast<int>(i)) <= s.r_far_m) state->order.push_back(static_cast<int>(i));
  }
  std::sort(state->order.begin(), state->order.end(), [&](int a, int b) {
    const float da = distance(a), db = distance(b);
    return da != db ? da < db : crowd.id[static_cast<size_t>(a)] < crowd.id[static_cast<size_t>(b)];
  });

  // r_high moves towards the distance that leaves `limit` people inside, smoothly.
  float wanted_m = s.r_high_m * kStretch;
  if (static_cast<size_t>(limit) < state->order.size()) {
    wanted_m = std::min(wanted_m, distance(state->order[static_cast<size_t>(limit)]));
  }
  const float most_m = kBoundarySpeed_mps * step_s;
  state->r_high_m += std::clamp(wanted_m - state->r_high_m, -most_m, most_m);

  const int64_t budget = static_cast<int64_t>(state->budget_triangles);
  const int64_t drawable = std::min<int64_t>(static_cast<int64_t>(state->order.size()), budget / kImpostorTriangles);
  state->triangles = drawable * kImpostorTriangles;
  state->high = state->low = state->shortfalls = state->switches_in_view = 0;
  int within_nominal = 0;
  for (size_t rank = 0; rank < state->order.size(); ++rank) {
    const size_t i = static_cast<size_t>(state->order[rank]);
    const float distance_m = distance(static_cast<int>(i));
    if (distance_m < s.r_high_m) ++within_nominal;
    if (static_cast<int64_t>(rank) >= drawable) continue;
    const AvatarCosts& avatar = avatars[static_cast<size_t>(crowd.avatar[i])];
    const float px = PixelsHigh(avatar.height_m, distance_m, camera, s.screen_width_px);
    const int last = LastLevel(*state, i, crowd.id[i]);
    const float reach_m = state->r_high_m + (last >= 0 ? kHysteresis_m : 0);
    int level = kImpostor;
    if (distance_m < reach_m && state->high < limit) {
      for (int k = WantedLevel(avatar, last >= 0 ? px * 1.1f : px); k < static_cast<int>(avatar.levels.size()); ++k) {
        const int more = avatar.levels[static_cast<size_t>(k)].triangles - kImpostorTriangles;
        if (state->triangles + more > budget) continue;
        level = k;
        state->triangles += more;
        break;
      }
    }
    state->level[i] = level;
    if (level >= 0) ++state->high;
    else ++state->low;
    if (level == kImpostor && px > avatar.impostor_px) ++state->shortfalls;
    if (last != kNotDrawn && last != level) ++state->switches_in_view;
  }
  state->exceeded = within_nominal > s.high_limit;
  state->id = crowd.id;
}

}  // namespace flaneur
