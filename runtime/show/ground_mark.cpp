#include "runtime/show/ground_mark.h"

#include <cmath>

namespace flaneur {
namespace {

constexpr int kCorners = 32;
constexpr float kInner_m = 0.26f, kOuter_m = 0.36f;
constexpr float kClearInner_m = 0.2f, kClearOuter_m = 0.45f;  // for who sees badly
constexpr float kAbove_m = 0.03f;  // the ground, whose drawn surface is not quite the raster's

}  // namespace

void RingWherePointed(const Simulation& s, std::vector<Vec3>* strip) {
  strip->clear();
  if (s.visitor.point_walk.route.points.empty()) return;
  const bool clear = s.visitor.comfort.clear_marks;
  const Vec2 middle = s.visitor.point_walk.route.points.back();
  for (int k = 0; k <= kCorners; ++k) {
    const float angle = 2 * kPi * static_cast<float>(k) / kCorners;
    for (const float radius_m : {clear ? kClearInner_m : kInner_m, clear ? kClearOuter_m : kOuter_m}) {
      const Vec2 p = middle + Vec2{std::cos(angle), std::sin(angle)} * radius_m;
      const Vec2 known = OnGround(s.town.walkable, p) ? p : middle;
      strip->push_back({p.x, p.y, HeightAt(s.town.walkable, known) + kAbove_m});
    }
  }
}

}  // namespace flaneur
