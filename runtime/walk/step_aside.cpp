#include "runtime/walk/step_aside.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/walls.h"
#include "runtime/walk/visitor.h"

namespace flaneur {
namespace {

constexpr float kSeen_m = 7;                          // so far ahead
constexpr float kComes_mps = 0.3f;                    // towards the visitor
constexpr float kInTheWay_m = 1.5f;                   // to either side
constexpr float kPasses_m = 0.08f;                    // beyond touching
constexpr float kWidest_m = 2.5f;                     // looked for room to either side
constexpr float kCloses_m = 0.4f, kFollows_m = 1.0f;  // beyond the personal space, of who follows
constexpr float kLeastPace = 0.2f;
constexpr float kShortest_m = 0.6f;  // ahead, in which to be aside

}  // namespace

Vec2 StepAside(const VisitorInTown& v, Vec2 way) {
  const Crowd& c = v.town.crowd;
  const Vec2 p = v.visitor.camera.view.position;
  float nearest_m = kSeen_m;
  size_t who = c.size();
  for (size_t i = 0; i < c.size(); ++i) {
    const Vec2 off = c.position[i] - p;
    const float ahead_m = Dot(off, way);
    if (ahead_m <= 0 || ahead_m >= nearest_m || std::abs(Cross(way, off)) > kInTheWay_m) continue;
    if (Dot(c.velocity[i], way) < -kComes_mps) nearest_m = ahead_m, who = i;
  }
  if (who == c.size()) return way;
  const Vec2 left{-way.y, way.x};
  const auto room_m = [&](Vec2 from, float side, float radius_m) {
    return RoomAlong_m(v.town.walkable, from, left * side, radius_m, kWidest_m);
  };
  const float reach_m = v.settings.r_personal_m + c.radius_m[who] + kPasses_m;
  const float off_m = Cross(way, c.position[who] - p);  // to the left
  float least_m = 1e9f, chosen = 0;
  for (const float side : {-1.0f, 1.0f}) {  // where the visitor goes; the other one passes on the other side
    const float theirs_m = room_m(c.position[who], -side, c.radius_m[who]) - side * off_m;
    const float needed_m = reach_m - theirs_m;
    if (needed_m <= 0) return way;
    const float own_m = room_m(p, side, CameraRadius_m(v.town.walkable));
    if (needed_m <= own_m + 1e-3f && needed_m < least_m - 0.2f) least_m = needed_m, chosen = side;
  }
  if (chosen == 0) return way;
  const Vec2 aside = way * std::max(nearest_m / 3, kShortest_m) + left * (chosen * least_m);
  return aside * (1 / Length(aside));
}

float PaceBehind(const VisitorInTown& v, Vec2 way) {
  const Crowd& c = v.town.crowd;
  const Vec2 p = v.visitor.camera.view.position;
  float share = 1;
  for (size_t i = 0; i < c.size(); ++i) {
    const Vec2 off = c.position[i] - p;
    const float ahead_m = Dot(off, way), gap_m = ahead_m - v.settings.r_personal_m - c.radius_m[i];
    if (ahead_m <= 0 || gap_m > kFollows_m || std::abs(Cross(way, off)) > kInTheWay_m) continue;
    if (Dot(c.velocity[i], way) < kComes_mps || LetsPass(v, p, way, c.radius_m[i])) continue;
    share = std::min(share, std::clamp((gap_m - kCloses_m) / (kFollows_m - kCloses_m), kLeastPace, 1.0f));
  }
  return share;
}

bool LetsPass(const VisitorInTown& v, Vec2 p, Vec2 way, float radius_m) {
  const Vec2 left{-way.y, way.x};
  const float reach_m = v.settings.r_personal_m + radius_m + kPasses_m;
  const auto has_room = [&](Vec2 out) { return RoomAlong_m(v.town.walkable, p, out, radius_m, reach_m) >= reach_m; };
  return has_room(left) || has_room(left * -1);
}

}  // namespace flaneur
