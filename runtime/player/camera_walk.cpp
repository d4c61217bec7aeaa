#include "runtime/player/camera_walk.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/fast_math.h"
#include "runtime/crowd/walls.h"
#include "runtime/player/guide.h"
#include "runtime/player/loitering.h"

namespace flaneur {
namespace {

constexpr float kTourYawRate_radps = 0.9f;    // a calm turn of the head
constexpr float kLookAhead_m = 3.0f;          // people within this ahead slow the camera
constexpr float kDenseAhead_pm2 = 5.4f;       // nobody walks at this density (Weidmann 1993)
constexpr float kLeastFactor = 0.2f;
constexpr float kReached_m = 0.3f;
constexpr float kGiveUp_s = 6;                // a leg whose way is barred ends
constexpr float kGettingOn_m = 0.5f;          // who stays within this is stuck, even if not quite still
constexpr float kTourSpeed_mps = 1.3f;
constexpr float kLooksAhead_m = 2.5f;         // along the tour's route
constexpr float kAtHalt_m = 1;
constexpr float kGentleYawRate_radps = 0.35f, kGentleSpeed_mps = 1.0f;
constexpr float kLooksAbout_s = 2.5f;         // after looking to the side, until the tour turns the view again
constexpr float kGiveUpPoint_s = 3;
constexpr float kStands = 0.05f;              // share of the pace
constexpr float kSidestep_m = 0.7f;           // looked ahead when walking round people
constexpr float kPatience_s = 1.5f;           // after which those who stand in the way move on
constexpr float kStirs_m = 2;

void TurnTowards(float yaw_rad, float rate_radps, Simulation* s) {
  const float most = rate_radps * s->step_s;
  const float turn = std::clamp(WrapAngle(yaw_rad - s->camera.view.yaw_rad), -most, most);
  s->camera.view.yaw_rad = WrapAngle(s->camera.view.yaw_rad + turn);
  s->camera.yaw_rate_radps = turn / s->step_s;
}

// The user's speed falls in proportion to the density of the crowd ahead.
float DensityFactor(const Simulation& s, Vec2 direction) {
  float people = 0;
  for (size_t i = 0; i < s.crowd.size(); ++i) {
    const Vec2 off = s.crowd.position[i] - s.camera.view.position;
    const float distance_m = Length(off);
    if (distance_m < kLookAhead_m && Dot(off, direction) > 0.7071f * distance_m) people += 1;
  }
  const float density = people / (kPi / 4 * kLookAhead_m * kLookAhead_m);
  return std::clamp(1 - density / kDenseAhead_pm2, kLeastFactor, 1.0f);
}

// How far the camera may go along the step without anybody coming within r_personal who was not already.
float FreeShare(const Simulation& s, Vec2 step) {
  float share = 1;
  const float step2 = Dot(step, step);
  if (step2 <= 0) return 0;
  for (size_t i = 0; i < s.crowd.size(); ++i) {
    const Vec2 off = s.crowd.position[i] - s.camera.view.position;
    const float reach_m = s.r_personal_m + s.crowd.radius_m[i] + 0.06f;  // room for the person's own next step
    const float along = Dot(off, step);
    if (along <= 0) continue;
    const float gap2 = Dot(off, off) - reach_m * reach_m;
    if (gap2 <= 0) return 0;
    const float discriminant = along * along - step2 * gap2;
    if (discriminant <= 0) continue;
    share = std::min(share, std::max(0.0f, (along - std::sqrt(discriminant)) / step2));
  }
  return share;
}

// The guided visitor walks round people who stand in the way: the direction near `way` in which most of it is free.
Vec2 RoundPeople(const Simulation& s, Vec2 way) {
  Vec2 best = way;
  float most = 0;
  for (const float turn : {0.0f, -0.5f, 0.5f, -1.0f, 1.0f, -1.5f, 1.5f}) {  // the right first, as people pass
    const Vec2 direction{way.x * std::cos(turn) - way.y * std::sin(turn), way.x * std::sin(turn) + way.y * std::cos(turn)};
    if (!IsFree(s.walkable, s.camera.view.position + direction * kSidestep_m)) continue;
    const float progress_m = FreeShare(s, direction * kSidestep_m) * (std::cos(turn) + 0.2f);
    if (progress_m > most + 0.01f) most = progress_m, best = direction;
  }
  return best;
}

void Walk(Vec2 direction, float asked_mps, Simulation* s) {
  CameraState& camera = s->camera;
  camera.asked_mps = asked_mps;
  camera.asked_velocity = direction * asked_mps;
  const Vec2 before = camera.view.position;
  const float speed = asked_mps * DensityFactor(*s, direction);
  Vec2 step = direction * (speed * s->step_s);
  step = step * FreeShare(*s, step);
  const Vec2 target = before + step;
  if (InsideObstacle(s->walkable, before)) camera.view.position = target;  // let a camera out that a scenario put in a wall
  else camera.view.position = KeepOffWalls(s->walkable, before, target, kCameraRadius_m);
  camera.velocity = (camera.view.position - before) * (1 / s->step_s);
  camera.actual_mps = Length(camera.velocity);
  const bool got_on = Length(camera.view.position - s->stuck_at) > kGettingOn_m;
  s->stuck_s = got_on ? 0 : s->stuck_s + s->step_s;
  if (got_on) s->stuck_at = camera.view.position;
}

void NextLeg(Simulation* s) {
  s->leg_done = 0;
  s->stuck_s = 0;
  if (++s->leg >= s->legs.size()) s->finished = true;
}

void FollowLegs(Simulation* s) {
  const CameraLeg& leg = s->legs[s->leg];
  switch (leg.kind) {
    case CameraLeg::Kind::kWait:
      s->leg_done += s->step_s;
      if (s->leg_done >= leg.wait_s) NextLeg(s);
      return;
    case CameraLeg::Kind::kTurn: {
      const float left = std::abs(leg.turn_deg * kPi / 180) - s->leg_done;
      const float turn = std::min(left, leg.rate_dps * kPi / 180 * s->step_s);
      s->leg_done += turn;
      const float signed_turn = leg.turn_deg >= 0 ? turn : -turn;
      s->camera.view.yaw_rad = WrapAngle(s->camera.view.yaw_rad + signed_turn);
      s->camera.yaw_rate_radps = signed_turn / s->step_s;
      if (left - turn <= 1e-6f) NextLeg(s);
      return;
    }
    case CameraLeg::Kind::kWalk: {
      const Vec2 way = leg.to_m - s->camera.view.position;
      const float way_m = Length(way);
      if (way_m < kReached_m || s->stuck_s > kGiveUp_s) return NextLeg(s);
      TurnTowards(std::atan2(way.y, way.x), s->max_yaw_rate_radps * 0.75f, s);
      Walk(way * (1 / way_m), leg.speed_mps, s);
      return;
    }
  }
}

float TourSpeed_mps(const Simulation& s) { return s.gentle ? kGentleSpeed_mps : kTourSpeed_mps; }

// Unless the visitor looks elsewhere just now.
void TurnForTour(float yaw_rad, Simulation* s) {
  if (s->looks_about_s <= 0) TurnTowards(yaw_rad, s->gentle ? kGentleYawRate_radps : kTourYawRate_radps, s);
}

void Turn(float yaw_rate_radps, Simulation* s) {
  CameraState& camera = s->camera;
  camera.yaw_rate_radps = std::clamp(yaw_rate_radps, -s->max_yaw_rate_radps, s->max_yaw_rate_radps);
  camera.view.yaw_rad = WrapAngle(camera.view.yaw_rad + camera.yaw_rate_radps * s->step_s);
}

// The visitor looks to the side while the tour leads on.
void LookAbout(const CameraInput& input, Simulation* s) {
  s->looks_about_s -= s->step_s;
  if (input.yaw_rate_radps == 0) return;
  s->looks_about_s = kLooksAbout_s;
  Turn(input.yaw_rate_radps, s);
}

// On the way to where the visitor pointed.
void FollowPoint(float speed_mps, bool turns, Simulation* s) {
  PointWalk& walk = s->point_walk;
  const Vec2 p = s->camera.view.position;
  walk.way_m = WayTo(walk.route, p, walk.way_m - 1, walk.way_m + 2);
  const bool there = LengthOf_m(walk.route) - walk.way_m < kReached_m;
  const Vec2 way = WayAlong(s->walkable, walk.route, walk.way_m, p, &walk.corner, &s->crowd.search);
  if (there || Length(way) < 0.5f || s->stuck_s > kGiveUpPoint_s) {
    walk = {};
    return;
  }
  const Vec2 look = PointAt(walk.route, walk.way_m + kLooksAhead_m) - p;
  if (!turns && Length(look) > kReached_m) TurnForTour(std::atan2(look.y, look.x), s);
  Walk(RoundPeople(*s, way), speed_mps, s);
}

// For somebody who walked about while the tour rests.
void ReturnToHalt(Simulation* s) {
  const Vec2 p = s->camera.view.position;
  const Vec2 way = WayStraightOrRound(s->walkable, p, s->tour.stops[HaltOf(s->tour)].position_m, &s->tour.corner, &s->crowd.search);
  if (Length(way) < 0.5f) return;
  TurnForTour(std::atan2(way.y, way.x), s);
  Walk(RoundPeople(*s, way), TourSpeed_mps(*s), s);
}

void FollowTour(const CameraInput& input, Simulation* s) {
  Tour& t = s->tour;
  const Vec2 p = s->camera.view.position;
  LookAbout(input, s);
  if (t.resting && Length(t.stops[HaltOf(t)].position_m - p) < kAtHalt_m) {
    return TurnForTour(t.stops[HaltOf(t)].yaw_rad, s);
  }
  if (t.over) return TurnForTour(LookOfLeave_rad(s->camera.view.yaw_rad, s), s);
  if (t.paused) return;
  if (t.resting) return ReturnToHalt(s);
  const Vec2 way = WayAlong(s->walkable, t.route, t.visitor_m, p, &t.corner, &s->crowd.search);
  if (s->stuck_s > kGiveUp_s || Length(way) < 0.5f) {
    s->stuck_s = 0;
    return GiveUpStop(s);
  }
  const Vec2 look = PointAt(t.route, t.visitor_m + kLooksAhead_m) - p;
  if (Length(look) > kReached_m) TurnForTour(std::atan2(look.y, look.x), s);
  const float pace = ShareOfPace(*s);
  if (pace > kStands) Walk(RoundPeople(*s, way), TourSpeed_mps(*s) * pace, s);
  else s->stuck_s = 0;
}

}  // namespace

void MoveCamera(const CameraInput& input, Simulation* s) {
  CameraState& camera = s->camera;
  camera.velocity = camera.asked_velocity = {};
  camera.yaw_rate_radps = camera.asked_mps = camera.actual_mps = 0;
  if (!camera.present) return;
  if (input.pitch_rad) camera.pitch_rad = *input.pitch_rad;
  if (input.walk_to) SetOut(*input.walk_to, s);
  if (!input.active || input.speed_mps > 0) s->point_walk = {};
  if (input.active) {
    s->looks_about_s = 0;
    Turn(input.yaw_rate_radps, s);
    if (input.speed_mps > 0) Walk(input.direction, input.speed_mps, s);
    else if (!s->point_walk.route.points.empty()) FollowPoint(input.walk_to_mps, input.yaw_rate_radps != 0, s);
    return;
  }
  if (s->finished && !s->tour.over) return;
  if (!s->legs.empty()) FollowLegs(s);
  else if (!s->tour.stops.empty()) FollowTour(input, s);
  if (s->stuck_s >= kPatience_s) StirLoiterers(camera.view.position, kStirs_m, s);
}

}  // namespace flaneur
