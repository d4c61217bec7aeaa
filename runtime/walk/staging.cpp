#include "runtime/walk/staging.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/fast_math.h"
#include "runtime/walk/step_aside.h"
#include "runtime/walk/visitor.h"

namespace flaneur {
namespace {

constexpr float kHalfWidth_m = 0.5f;  // of a guide with the banner
constexpr float kLeastDepth_m = 2.6f, kMostDepth_m = 7;
constexpr float kFeetClear = 1.18f;  // of the depth at which feet stand on the picture's lower edge
constexpr float kSideClear_m = 0.12f;
constexpr float kTangent_m = 0.4f, kRoomStep_m = 0.25f;
constexpr float kRoomAhead_m[] = {-1, 0, 1.5f, 3};  // where along the route there should be room
constexpr float kLooksBeforeHalt_m = 8, kTurnsWithin_m = 4, kMostOffWay_rad = 0.6f, kMostBeforeHalt_rad = 0.9f;
constexpr float kAtHalt_m = 2.5f, kMoreAtHalt_rad = 0.5f;  // in the last steps
constexpr float kTurnsToSight_m = 1.4f;                    // within this, wherever the way goes; at half of it wholly
constexpr float kGuideWithin = 0.8f;                       // of half the view
constexpr float kTurnAhead_m = 6, kTurn_rad = 0.5f;        // a turn within that counts
constexpr float kStartTurn_rad = 0.35f, kBehind_rad = 2.2f;
constexpr float kSightAhead_m = 20;
constexpr float kCrosses = 0.6f;  // of a place beyond the way by which the visitor comes
constexpr float kOfTurn = 0.25f, kOfStart = 0.5f, kOfNow = 0.35f,
                kOfSight = 0.6f;  // preferences, in shares of the room that it takes

Vec2 LeftOf(Vec2 along) { return {-along.y, along.x}; }

float HalfTan(const CameraState& camera) { return std::tan(camera.view.fov_rad / 2); }

// How far to that side of the route one can walk.
float Room_m(float way_m, float side, float most_m, const VisitorInTown& v) {
  const Vec2 on = PointAt(v.visitor.tour.route, way_m), out = LeftOf(AlongRoute(v.visitor.tour.route, way_m)) * side;
  float room_m = 0;
  while (room_m < most_m && IsFree(v.town.walkable, on + out * (room_m + kRoomStep_m))) room_m += kRoomStep_m;
  return std::min(room_m, most_m);
}

// What is wrong with standing there before a visitor at the stop who looks that way: the share of the guide in the
// picture's middle third and beyond its edges.
float Intrusion(const CameraState& camera, float depth_m, float side_m) {
  const float half_m = depth_m * HalfTan(camera), third_m = half_m / 3;
  const float left_m = side_m - kHalfWidth_m, right_m = side_m + kHalfWidth_m;
  const auto within = [&](float low_m, float high_m) {
    return std::max(0.0f, std::min(right_m, high_m) - std::max(left_m, low_m)) / (2 * kHalfWidth_m);
  };
  const float feet = camera.eye_height_m * camera.aspect / (half_m * 1.0f);  // 1: at the lower edge
  return 6 * within(-third_m, third_m) + 3 * (1 - within(-half_m, half_m)) + 1.5f * std::max(0.0f, feet - 1);
}

// Which side of the way the guide is going to stand on at a halt that looks back along it: else they would cross it
// before the visitor. 0: no such halt comes soon.
float SideOfSightBehind(float way_m, const VisitorInTown& v) {
  const GuidedTour& t = v.visitor.tour;
  const float end_m = LengthOf_m(t.route);
  if (end_m - way_m > kSightAhead_m) return 0;
  const Vec2 arrives = AlongRoute(t.route, end_m), look = DirectionOf(LookAt_rad(t, HaltOf(t)));
  return Dot(arrives, look) < 0 ? std::copysign(1.0f, Cross(arrives, look)) : 0;
}

// In a lane where nobody gets past who stands in it: out of the picture, where need be.
Vec2 Beyond(Vec2 halt, Vec2 way, float far_m, const VisitorInTown& v) {
  while (far_m > 0 && !FreeLine(v.town.walkable, halt, halt + way * far_m)) far_m -= kRoomStep_m;
  return halt + way * std::max(far_m, 0.0f);
}

}  // namespace

Vec2 AlongRoute(const Route& route, float way_m) {
  const Vec2 along = PointAt(route, way_m + kTangent_m) - PointAt(route, way_m - kTangent_m);
  return Length(along) > 1e-3f ? Unit(along) : Vec2{};
}

float LeadDepth_m(const CameraState& camera) {
  const float feet_m = camera.eye_height_m * camera.aspect / HalfTan(camera);
  return std::clamp(kFeetClear * feet_m, kLeastDepth_m, kMostDepth_m);
}

float ClearSide_m(const CameraState& camera, float depth_m) {
  return depth_m * HalfTan(camera) / 3 + kHalfWidth_m + kSideClear_m;
}

Vec2 PlaceBesideSight(size_t halt, Vec2 from, const VisitorInTown& v) {
  const GuidedTour& t = v.visitor.tour;
  const CameraState& camera = v.visitor.camera;
  const TourStop& stop = t.stops[halt];
  const Vec2 look = DirectionOf(LookAt_rad(t, halt)), left = LeftOf(look);
  const Vec2 next = t.stops[std::min(halt + 1, t.stops.size() - 1)].position_m;
  const float depth_m = LeadDepth_m(camera);
  const float least_m = v.settings.r_personal_m + 2 * kHalfWidth_m;
  const Vec2 arrives = AlongRoute(t.route, LengthOf_m(t.route));
  const float from_side = Cross(arrives, from - stop.position_m);
  const bool passes = Length(arrives) == 0 || LetsPass(v, stop.position_m, arrives, kHalfWidth_m);
  Vec2 best = stop.position_m;
  float least_cost = 1e9f;
  for (const float farther_m : {0.0f, 0.8f, -0.8f, 1.6f, -1.6f, -2.4f, -3.2f, -4.0f}) {
    const float ahead_m = depth_m + farther_m, clear_m = ClearSide_m(camera, std::max(0.0f, ahead_m));
    if (ahead_m < 0.3f) continue;
    for (const float of_clear : {1.0f, 1.25f, 1.5f, 0.85f, 0.7f, 0.5f, 0.0f}) {
      for (const float side : {-1.0f, 1.0f}) {
        const float side_m = side * of_clear * clear_m;
        const Vec2 p = stop.position_m + look * ahead_m + left * side_m;
        if (Length(p - stop.position_m) < least_m || !IsFree(v.town.walkable, p)) continue;
        const Vec2 off = p - stop.position_m;
        if (!passes && Dot(arrives, off) < 0) continue;  // the guide comes first, and stays before the visitor
        const bool crosses = Dot(arrives, off) < 0 && Cross(arrives, off) * from_side < 0;
        const float cost = Intrusion(camera, ahead_m, side_m) + 0.05f * std::abs(farther_m) + 0.02f * Length(p - from) +
                           0.01f * Length(p - next) + (crosses ? kCrosses : 0);
        if (cost < least_cost && FreeLine(v.town.walkable, stop.position_m, p)) least_cost = cost, best = p;
      }
    }
  }
  if (least_cost == 1e9f && !passes) return Beyond(stop.position_m, arrives, depth_m, v);
  return best;
}

float SideToWalk(float way_m, float now, const VisitorInTown& v) {
  const GuidedTour& t = v.visitor.tour;
  const float takes_m = ClearSide_m(v.visitor.camera, LeadDepth_m(v.visitor.camera));
  const Vec2 here = AlongRoute(t.route, way_m), later = AlongRoute(t.route, way_m + kTurnAhead_m);
  const float turn_rad = Length(here) > 0 && Length(later) > 0 ? WrapAngle(AngleOf(later) - AngleOf(here)) : 0;
  const float start_rad = Length(here) > 0 ? WrapAngle(AngleOf(here) - v.visitor.camera.view.yaw_rad) : 0;
  const float sight = SideOfSightBehind(way_m, v);
  const auto worth = [&](float side) {
    float room_m = takes_m;
    for (const float ahead_m : kRoomAhead_m) room_m = std::min(room_m, Room_m(way_m + ahead_m, side, takes_m, v));
    float points = room_m / takes_m;
    if (side * turn_rad > kTurn_rad) points += kOfTurn;
    if (now == side) points += kOfNow;
    if (side == sight) points += kOfSight;
    if (now == 0 && side * start_rad > kStartTurn_rad && std::abs(start_rad) < kBehind_rad) points += kOfStart;
    return points;
  };
  return worth(-1) > worth(1) ? -1.0f : 1.0f;
}

Vec2 BesideRoute(float way_m, float side, const VisitorInTown& v) {
  const Route& route = v.visitor.tour.route;
  const float takes_m = ClearSide_m(v.visitor.camera, LeadDepth_m(v.visitor.camera));
  const Vec2 out = LeftOf(AlongRoute(route, way_m)) * side;
  return PointAt(route, way_m) + out * Room_m(way_m, side, takes_m, v);
}

std::optional<Vec2> WayToGuide(const VisitorInTown& v) {
  const Guide& g = v.visitor.guide;
  if (g.id < 0 || g.index >= v.town.crowd.size()) return std::nullopt;
  return v.town.crowd.position[g.index] - v.visitor.camera.view.position;
}

float LookOffWay_rad(float way_rad, const VisitorInTown& v) {
  const GuidedTour& t = v.visitor.tour;
  const float left_m = LengthOf_m(t.route) - t.visitor_m;
  const float arrives = std::clamp((kLooksBeforeHalt_m - left_m) / kTurnsWithin_m, 0.0f, 1.0f);
  const float most_rad = kMostOffWay_rad + arrives * (kMostBeforeHalt_rad - kMostOffWay_rad) +
                         kMoreAtHalt_rad * std::clamp(1 - left_m / kAtHalt_m, 0.0f, 1.0f);
  const float sight_rad = WrapAngle(LookAt_rad(t, HaltOf(t)) - way_rad);
  const float to_one_side = std::min(1.0f, kPi - std::abs(sight_rad));  // what lies behind is on neither
  float look_rad = arrives * to_one_side * std::clamp(sight_rad, -most_rad, most_rad);
  if (const auto guide = WayToGuide(v)) {
    const float guide_rad = WrapAngle(AngleOf(*guide) - way_rad);
    const float within_rad = kGuideWithin * v.visitor.camera.view.fov_rad / 2;
    if (std::abs(guide_rad) < kBehind_rad)
      look_rad = std::clamp(look_rad, guide_rad - within_rad, guide_rad + within_rad);
  }
  look_rad = std::clamp(look_rad, -most_rad, most_rad);
  // Whoever has to walk round people there may come from any side.
  const float from_halt_m = Length(t.stops[HaltOf(t)].position_m - v.visitor.camera.view.position);
  const float there = std::clamp((kTurnsToSight_m - from_halt_m) / kTurnsToSight_m * 2, 0.0f, 1.0f);
  return look_rad + there * WrapAngle(sight_rad - look_rad);
}

float LookAside_rad(float look_rad, float most_rad, const VisitorInTown& v) {
  const Guide& g = v.visitor.guide;
  const CameraState& camera = v.visitor.camera;
  const auto off = WayToGuide(v);
  if (!off) return 0;
  const float far_m = Length(*off), at_rad = WrapAngle(AngleOf(*off) - look_rad);
  if (far_m < 1 || at_rad * (g.is_left ? 1.0f : -1.0f) <= 0 || std::abs(at_rad) > camera.view.fov_rad / 2) return 0;
  const float takes_rad = std::atan(HalfTan(camera) / 3) + std::atan((kHalfWidth_m + kSideClear_m) / far_m);
  return (g.is_left ? -1.0f : 1.0f) * std::clamp(takes_rad - std::abs(at_rad), 0.0f, most_rad);
}

}  // namespace flaneur
