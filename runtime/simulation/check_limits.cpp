#include "runtime/simulation/check_limits.h"

#include <algorithm>
#include <cstdio>

#include "runtime/town/places.h"

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
  for (const AvatarCosts& avatar : s.control.avatars) {
    for (const LevelCost& level : avatar.levels)
      fewest = fewest == 0 ? level.triangles : std::min(fewest, level.triangles);
  }
  return fewest;
}

}  // namespace

Error CheckLimits(Simulation* s) {
  const ControlSettings& c = s->control.settings;
  const auto contradict = [&](const char* less, float less_m, const char* more, float more_m) {
    return Fail(std::string("contradictory limits: ") + less + " " + Metres(less_m) + " must be below " + more + " " +
                Metres(more_m));
  };
  if (c.r_high_m > 0 && c.r_high_m <= c.r_personal_m) {  // 0 is for nobody in high resolution
    return contradict("r_personal_m", c.r_personal_m, "camera.r_high_m", c.r_high_m);
  }
  if (c.r_high_m >= c.r_far_m) return contradict("camera.r_high_m", c.r_high_m, "r_far_m", c.r_far_m);
  if (s->town.crowd_area && s->town.settings.people > 0 && HomeCells(s->town).empty()) {
    return Fail("crowd_area holds no walkable ground that leads anywhere; nobody can live there");
  }
  const int64_t least = static_cast<int64_t>(c.high_limit) * FewestTriangles(*s);
  if (c.method == LimitMethod::kCount && least > c.budget_triangles) {
    s->town.warnings.push_back("contradictory limits: " + std::to_string(c.high_limit) +
                               " people in high resolution have at least " + std::to_string(least) +
                               " triangles, budget_triangles is " + std::to_string(c.budget_triangles) +
                               "; the budget holds");
  }
  return Ok();
}

}  // namespace flaneur
