#include "runtime/control/serving_order.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/fast_math.h"

namespace flaneur {
namespace {

constexpr float kHysteresis_m = 2.0f;  // a mesh stays one until this far beyond r_high
constexpr float kWorthwhile_s = 4.0f;  // who leaves the view sooner is not worth a switch any more,
constexpr float kPasses_m = 1.8f;      // but for those who pass so near
constexpr float kSoon_s = 8.0f;        // who comes near by then is served first when they come into view
constexpr float kLong_s = 1e3f;

// How long somebody stays in view, with any part, if the camera and they go on as they do.
float StaysInView_s(Vec2 off, float reach_m, Vec2 velocity, const ViewMotion& motion, const ViewEdges& edges) {
  const Vec2 drift =
      velocity - motion.velocity + Vec2{off.y, -off.x} * motion.yaw_rate_radps;  // as seen from a camera that turns
  float stays_s = kLong_s;
  for (const Vec2 inward : edges.inward) {
    const float outward_mps = -Dot(inward, drift);
    if (outward_mps > 0) stays_s = std::min(stays_s, std::max(Dot(inward, off) + reach_m, 0.0f) / outward_mps);
  }
  return stays_s;
}

bool LeavesSoon(Vec2 off, float reach_m, Vec2 velocity, const ViewMotion& motion, const ViewEdges& edges) {
  const float stays_s = StaysInView_s(off, reach_m, velocity, motion, edges);
  const Vec2 leaves = off + (velocity - motion.velocity) * stays_s;
  return stays_s < kWorthwhile_s && Length(leaves) > kPasses_m;
}

// How near somebody comes within kSoon_s, walking on as they mean to.
float ComesWithin_m(const Crowd& c, size_t i, Vec2 off, const ViewMotion& motion) {
  Vec2 way;
  if (c.activity[i] == Activity::kWalking && c.field[i] >= 0) {
    const bool known = c.way[i].x != 0 || c.way[i].y != 0;  // not before the first step
    way = known ? c.way[i] : Unit(c.fields[static_cast<size_t>(c.field[i])].goal - c.position[i]);
  }
  const Vec2 drift = way * c.preferred_mps[i] - motion.velocity;
  const float speed2 = Dot(drift, drift);
  const float nearest_s = speed2 > 1e-4f ? std::clamp(-Dot(off, drift) / speed2, 0.0f, kSoon_s) : 0;
  return Length(off + drift * nearest_s);
}

}  // namespace

ViewEdges EdgesOf(const ViewCamera& camera) {
  const float half_rad = camera.fov_rad / 2;
  const Vec2 left = DirectionOf(camera.yaw_rad + half_rad), right = DirectionOf(camera.yaw_rad - half_rad);
  return {{{left.y, -left.x}, {-right.y, right.x}}};
}

LevelState::InSight InOrder(const Crowd& crowd, size_t i, Vec2 off, Level last, const ViewEdges& edges, bool first,
                            const ControlSettings& s, const LevelState& state) {
  const float distance_m = Length(off);
  if (first) return {distance_m, -1e9f, static_cast<int>(i), crowd.id[i], kWithin};
  float key_m = distance_m - (IsMesh(last) ? kHysteresis_m : 0);
  Priority priority = key_m < state.r_high_m ? kWithin : IsMesh(last) ? kHolds : IsDrawn(last) ? kStays : kAppears;
  if (priority == kWithin && last == kImpostor &&
      LeavesSoon(off, crowd.view_reach_m[i], crowd.velocity[i], state.motion, edges))
    priority = kStays;
  if (priority == kStays && distance_m < std::min(kNear_m, s.r_high_m)) priority = kWhereRoom;
  if (priority == kAppears) key_m = ComesWithin_m(crowd, i, off, state.motion);
  return {distance_m, key_m, static_cast<int>(i), crowd.id[i], priority};
}

bool IsServedBefore(const LevelState::InSight& a, const LevelState::InSight& b) {
  if (a.priority != b.priority) return a.priority < b.priority;
  return a.key_m != b.key_m ? a.key_m < b.key_m : a.id < b.id;
}

}  // namespace flaneur
