#include "runtime/player/check_limits.h"

#include <algorithm>
#include <cstdio>

#include "runtime/player/places.h"

namespace flaneur {
namespace {

std::string Metres(float m) {
  char text[32];
  std::snprintf(text, sizeof text, "%g m", static_cast<double>(m));
  return text;
}

// Of the coarsest meshes there are.
int FewestTriangles(const Simulation& s) {
  int fewest = 0;
  for (const AvatarCosts& avatar : s.avatar_costs) {
    for (const LevelCost& level : avatar.levels) fewest = fewest == 0 ? level.triangles : std::min(fewest, level.triangles);
  }
  return fewest;
}

}  // namespace

Error CheckLimits(const Scenario& scenario, Simulation* s) {
  const float r_high_m = s->level_settings.r_high_m;
  const auto contradict = [&](const char* less, float less_m, const char* more, float more_m) {
    return Fail(std::string("contradictory limits: ") + less + " " + Metres(less_m) + " must be below " + more + " " + Metres(more_m));
  };
  const bool asked = scenario.r_high_m.has_value();  // 0 is for nobody in high resolution
  if (asked && r_high_m > 0 && r_high_m <= s->r_personal_m) return contradict("r_personal_m", s->r_personal_m, "camera.r_high_m", r_high_m);
  if (asked && r_high_m >= s->level_settings.r_far_m) return contradict("camera.r_high_m", r_high_m, "r_far_m", s->level_settings.r_far_m);
  if (scenario.crowd_area && s->crowd_settings.people > 0 && HomeCells(*s).empty()) {
    return Fail("crowd_area holds no walkable ground that leads anywhere; nobody can live there");
  }
  const int high = s->level_settings.high_limit;
  const int64_t least = static_cast<int64_t>(high) * FewestTriangles(*s);
  if (!s->level_settings.by_frame_time && least > s->level_settings.budget_triangles) {
    s->warnings.push_back("contradictory limits: " + std::to_string(high) + " people in high resolution have at least " +
                          std::to_string(least) + " triangles, budget_triangles is " +
                          std::to_string(s->level_settings.budget_triangles) + "; the budget holds");
  }
  return Ok();
}

}  // namespace flaneur
