#include "runtime/walk/camera_walk.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/array.h"
#include "runtime/crowd/fast_math.h"
#include "runtime/crowd/walls.h"
#include "runtime/town/loitering.h"
#include "runtime/walk/guide.h"
#include "runtime/walk/staging.h"
#include "runtime/walk/step_aside.h"
#include "runtime/walk/wander.h"

namespace flaneur {
namespace {

constexpr float kTourYawRate_radps = 0.9f;  // a calm turn of the head
constexpr float kLookAhead_m = 3.0f;        // people within this ahead slow the camera
constexpr float kDenseAhead_pm2 = 5.4f;     // nobody walks at this density (Weidmann 1993)
constexpr float kMinSpeedFactor = 0.2f;
constexpr float kReached_m = 0.3f;
constexpr float kGiveUp_s = 6;        // a leg whose way is barred ends
constexpr float kGettingOn_m = 0.5f;  // who stays within this is stuck, even if not quite still
constexpr float kTourSpeed_mps = 1.3f;
constexpr float kLooksAhead_m = 2.5f;  // along the tour's route
constexpr float kAtHalt_m = 1;
constexpr float kGentleYawRate_radps = 0.35f, kGentleSpeed_mps = 1.0f;
constexpr float kLooksAbout_s = 2.5f;  // after looking to the side, until the tour turns the view again
constexpr float kGiveUpPoint_s = 3, kGiveUpFarPoint_s = 10, kFarPoint_m = 20;  // the longer the way, the more patient
constexpr float kLooksAside_radps = 0.15f;  // from the guide, and so far: on the way, and from what there is to see
constexpr float kMostAside_rad = 0.19f, kMostAsideAtHalt_rad = 0.08f;
constexpr float kBack_rad = 2.3f;          // a turn of more goes by where the guide is
constexpr float kOnTheWay_rad = 0.3f;      // so much nearer the guide is to where the view turns
constexpr float kKeepsGuideWithin = 0.7f;  // of half the view
constexpr float kStands = 0.05f;           // share of the pace
constexpr float kSidestep_m = 0.7f;        // looked ahead when walking round people
constexpr float kPatience_s = 1.5f;        // after which those who stand in the way move on
constexpr float kLoitererYieldRadius_m = 2;
constexpr float kSideways = 0.4f;  // share of the pace, of a guided visitor who still looks aside of the way
constexpr float kBeforeSight_m = 2.2f,
                kBeforeSightRadius_m = 1.4f;  // where nobody goes on standing while a stop is shown

void TurnTowards(float yaw_rad, float rate_radps, const VisitorInTown& v) {
  const float most = rate_radps * Step_s(v.settings);
  const float turn = std::clamp(WrapAngle(yaw_rad - v.visitor.camera.view.yaw_rad), -most, most);
  v.visitor.camera.view.yaw_rad = WrapAngle(v.visitor.camera.view.yaw_rad + turn);
  v.visitor.camera.yaw_rate_radps = turn / Step_s(v.settings);
}

// Calls visit(position, radius_m) for everybody who can hold the visitor up.
template <typename Visit>
void VisitPeople(const VisitorInTown& v, Visit visit) {
  const Crowd& c = v.town.crowd;
  for (size_t i = 0; i < c.size(); ++i) visit(c.position[i], c.radius_m[i]);
  if (v.others == nullptr) return;
  for (size_t i = 0; i < v.others->position.size(); ++i) visit(v.others->position[i], v.others->radius_m[i]);
}

// The user's speed falls in proportion to the density of the crowd ahead.
float DensityFactor(const VisitorInTown& v, Vec2 direction) {
  float people = 0;
  VisitPeople(v, [&](Vec2 p, float) {
    const Vec2 off = p - v.visitor.camera.view.position;
    const float distance_m = Length(off);
    if (distance_m < kLookAhead_m && Dot(off, direction) > 0.7071f * distance_m) people += 1;
  });
  const float density = people / (kPi / 4 * kLookAhead_m * kLookAhead_m);
  return std::clamp(1 - density / kDenseAhead_pm2, kMinSpeedFactor, 1.0f);
}

// How far the camera may go along the step without anybody coming within r_personal who was not already.
float FreeShare(const VisitorInTown& v, Vec2 step) {
  float share = 1;
  const float step2 = Dot(step, step);
  if (step2 <= 0) return 0;
  VisitPeople(v, [&](Vec2 p, float radius_m) {
    const Vec2 off = p - v.visitor.camera.view.position;
    const float reach_m = v.settings.r_personal_m + radius_m + 0.06f;  // room for the person's own next step
    const float along = Dot(off, step);
    if (along <= 0) return;
    const float gap2 = Dot(off, off) - reach_m * reach_m, discriminant = along * along - step2 * gap2;
    if (gap2 <= 0) share = 0;
    else if (discriminant > 0) share = std::min(share, std::max(0.0f, (along - std::sqrt(discriminant)) / step2));
  });
  return share;
}

// The guided visitor walks round people who stand in the way: the direction near `way` in which most of it is free.
Vec2 RoundPeople(const VisitorInTown& v, Vec2 way) {
  Vec2 best = way;
  float most = 0;
  for (const float turn : {0.0f, -0.5f, 0.5f, -1.0f, 1.0f, -1.5f, 1.5f}) {  // the right first, as people pass
    const Vec2 direction{way.x * std::cos(turn) - way.y * std::sin(turn),
                         way.x * std::sin(turn) + way.y * std::cos(turn)};
    if (!IsFree(v.town.walkable, v.visitor.camera.view.position + direction * kSidestep_m)) continue;
    const float progress_m = FreeShare(v, direction * kSidestep_m) * (std::cos(turn) + 0.2f);
    if (progress_m > most + 0.01f) most = progress_m, best = direction;
  }
  return best;
}

void Walk(Vec2 direction, float asked_mps, const VisitorInTown& v) {
  CameraState& camera = v.visitor.camera;
  camera.asked_mps = asked_mps;
  camera.asked_velocity = direction * asked_mps;
  const Vec2 before = camera.view.position;
  const float speed = asked_mps * DensityFactor(v, direction);
  Vec2 step = direction * (speed * Step_s(v.settings));
  step = step * FreeShare(v, step);
  const Vec2 target = before + step;
  if (InsideObstacle(v.town.walkable, before))
    camera.view.position = target;  // let a camera out that a scenario put in a wall
  else camera.view.position = KeepOffWalls(v.town.walkable, before, target, CameraRadius_m(v.town.walkable));
  camera.velocity = (camera.view.position - before) * (1 / Step_s(v.settings));
  camera.actual_mps = Length(camera.velocity);
  const bool got_on = Length(camera.view.position - v.visitor.stuck_at) > kGettingOn_m;
  v.visitor.stuck_s = got_on ? 0 : v.visitor.stuck_s + Step_s(v.settings);
  if (got_on) v.visitor.stuck_at = camera.view.position;
}

// Straight on at first, then between both sides.
void LookToAndFro(const CameraLeg& leg, const VisitorInTown& v) {
  if (leg.look_about_deg <= 0) return;
  const float swung = std::fmod(v.visitor.leg_done * leg.rate_dps / leg.look_about_deg, 4.0f);
  const float rate_radps = (swung < 1 || swung >= 3 ? 1.0f : -1.0f) * leg.rate_dps * kPi / 180;
  v.visitor.camera.view.yaw_rad = WrapAngle(v.visitor.camera.view.yaw_rad + rate_radps * Step_s(v.settings));
  v.visitor.camera.yaw_rate_radps = rate_radps;
}

// Index of who is followed, or of the nearest who walks in view; -1: nobody does.
int WhomToFollow(const VisitorInTown& v) {
  const Crowd& c = v.town.crowd;
  int nearest = -1;
  float nearest_m = 1e9f;
  for (size_t i = 0; i < c.size(); ++i) {
    if (c.id[i] == v.visitor.followed_id) return static_cast<int>(i);
    const float away_m = Length(c.position[i] - v.visitor.camera.view.position);
    const bool walks = c.activity[i] == Activity::kWalking && c.field[i] >= 0;
    if (walks && c.view[i] == ViewClass::kVisible && away_m < nearest_m)
      nearest = static_cast<int>(i), nearest_m = away_m;
  }
  return nearest;
}

void FollowSomebody(const CameraLeg& leg, const VisitorInTown& v) {
  const int who = WhomToFollow(v);
  v.visitor.followed_id = who < 0 ? -1 : At(v.town.crowd.id, who);
  if (who < 0) return;
  const Vec2 way = At(v.town.crowd.position, who) - v.visitor.camera.view.position;
  const float way_m = Length(way);
  TurnTowards(AngleOf(way), MaxYawRate_radps(v.settings) * 0.75f, v);
  if (way_m > leg.behind_m) Walk(way * (1 / way_m), leg.speed_mps, v);
}

// True: the leg is over.
bool FollowLeg(const CameraLeg& leg, const VisitorInTown& v) {
  switch (leg.kind) {
    case CameraLeg::Kind::kWait:
      LookToAndFro(leg, v);
      v.visitor.leg_done += Step_s(v.settings);
      return v.visitor.leg_done >= leg.wait_s;
    case CameraLeg::Kind::kFollow:
      FollowSomebody(leg, v);
      v.visitor.leg_done += Step_s(v.settings);
      return v.visitor.leg_done >= leg.follow_s;
    case CameraLeg::Kind::kTurn: {
      const float left = std::abs(leg.turn_deg * kPi / 180) - v.visitor.leg_done;
      const float turn = std::min(left, leg.rate_dps * kPi / 180 * Step_s(v.settings));
      v.visitor.leg_done += turn;
      const float signed_turn = leg.turn_deg >= 0 ? turn : -turn;
      v.visitor.camera.view.yaw_rad = WrapAngle(v.visitor.camera.view.yaw_rad + signed_turn);
      v.visitor.camera.yaw_rate_radps = signed_turn / Step_s(v.settings);
      return left - turn <= 1e-6f;
    }
    case CameraLeg::Kind::kWalk: {
      const Vec2 way = leg.to_m - v.visitor.camera.view.position;
      const float way_m = Length(way);
      if (way_m < kReached_m || v.visitor.stuck_s > kGiveUp_s) return true;
      TurnTowards(std::atan2(way.y, way.x) + leg.facing_deg * kPi / 180, MaxYawRate_radps(v.settings) * 0.75f, v);
      Walk(way * (1 / way_m), leg.speed_mps, v);
      return false;
    }
    case CameraLeg::Kind::kWander:
      break;
  }
  return true;
}

void ForgetLeg(Visitor* visitor) {
  visitor->leg_done = visitor->stuck_s = 0;
  visitor->followed_id = -1;
}

// True: it is over.
bool Wander(const CameraLeg& leg, const VisitorInTown& v) {
  Visitor& visitor = v.visitor;
  const bool begins = visitor.wandered_s <= 0;
  if (begins) visitor.wander.state = leg.seed;
  visitor.wandered_s += Step_s(v.settings);
  if (begins || FollowLeg(visitor.drawn_leg, v)) {
    ForgetLeg(&visitor);
    visitor.drawn_leg = DrawLeg(v, &visitor.wander);
  }
  return visitor.wandered_s >= leg.wander_s;
}

void FollowLegs(const VisitorInTown& v) {
  const CameraLeg& leg = v.visitor.legs[v.visitor.leg];
  const bool over = leg.kind == CameraLeg::Kind::kWander ? Wander(leg, v) : FollowLeg(leg, v);
  if (!over) return;
  ForgetLeg(&v.visitor);
  v.visitor.wandered_s = 0;
  if (++v.visitor.leg >= v.visitor.legs.size()) v.visitor.finished = true;
}

float TourSpeed_mps(const VisitorInTown& v) {
  return (v.visitor.gentle ? kGentleSpeed_mps : kTourSpeed_mps) * v.visitor.comfort.pace;
}

// Unless the visitor looks elsewhere just now.
void TurnForTour(float yaw_rad, const VisitorInTown& v) {
  if (v.visitor.looks_about_s <= 0)
    TurnTowards(yaw_rad, v.visitor.gentle ? kGentleYawRate_radps : kTourYawRate_radps, v);
}

// With the guide to one side.
void TurnBeside(float yaw_rad, float most_aside_rad, const VisitorInTown& v) {
  Visitor& visitor = v.visitor;
  const float most = kLooksAside_radps * Step_s(v.settings);
  const float aside_rad = LookAside_rad(yaw_rad, most_aside_rad, v);
  visitor.looks_aside_rad += std::clamp(aside_rad - visitor.looks_aside_rad, -most, most);
  const float now_rad = visitor.camera.view.yaw_rad, turn_rad = WrapAngle(yaw_rad - now_rad);
  const auto guide = WayToGuide(v);
  const float guide_rad = guide ? WrapAngle(AngleOf(*guide) - now_rad) : 0;
  const bool on_the_way = std::abs(WrapAngle(turn_rad - guide_rad)) < std::abs(turn_rad) - kOnTheWay_rad;
  const bool back = on_the_way && std::abs(turn_rad) > kBack_rad && turn_rad * guide_rad < 0;
  TurnForTour(back ? now_rad + std::copysign(kBack_rad / 2, guide_rad) : yaw_rad + visitor.looks_aside_rad, v);
}

// Of a visitor who waits until the guide is ahead, while that leads out of the picture.
void LookAfterGuide(const VisitorInTown& v) {
  const auto guide = WayToGuide(v);
  if (!guide) return;
  const ViewCamera& view = v.visitor.camera.view;
  const float guide_rad = WrapAngle(AngleOf(*guide) - view.yaw_rad), most_rad = kKeepsGuideWithin * view.fov_rad / 2;
  if (std::abs(guide_rad) > most_rad) TurnForTour(view.yaw_rad + guide_rad - std::copysign(most_rad, guide_rad), v);
}

void TurnCamera(float yaw_rate_radps, const VisitorInTown& v) {
  CameraState& camera = v.visitor.camera;
  camera.yaw_rate_radps = std::clamp(yaw_rate_radps, -MaxYawRate_radps(v.settings), MaxYawRate_radps(v.settings));
  camera.view.yaw_rad = WrapAngle(camera.view.yaw_rad + camera.yaw_rate_radps * Step_s(v.settings));
}

// The visitor looks to the side while the tour leads on.
void LookAbout(const CameraInput& input, const VisitorInTown& v) {
  v.visitor.looks_about_s -= Step_s(v.settings);
  if (input.yaw_rate_radps == 0) return;
  v.visitor.looks_about_s = kLooksAbout_s;
  TurnCamera(input.yaw_rate_radps, v);
}

// On the way to where the visitor pointed.
void FollowPoint(float speed_mps, bool turns, const VisitorInTown& v) {
  PointWalk& walk = v.visitor.point_walk;
  const Vec2 p = v.visitor.camera.view.position;
  walk.way_m = WayTo(walk.route, p, walk.way_m - 1, walk.way_m + 2);
  const bool there = LengthOf_m(walk.route) - walk.way_m < kReached_m;
  const float give_up_s = LengthOf_m(walk.route) > kFarPoint_m ? kGiveUpFarPoint_s : kGiveUpPoint_s;
  const Vec2 way = WayAlong(v.town.walkable, walk.route, walk.way_m, p, &walk.corner, &v.town.crowd.search);
  if (there || Length(way) < 0.5f || v.visitor.stuck_s > give_up_s) {
    walk = {};
    return;
  }
  const Vec2 look = PointAt(walk.route, walk.way_m + kLooksAhead_m) - p;
  if (!turns && Length(look) > kReached_m) TurnForTour(std::atan2(look.y, look.x), v);
  Walk(RoundPeople(v, StepAside(v, way)), speed_mps, v);
}

// For somebody who walked about while the tour rests.
void ReturnToHalt(const VisitorInTown& v) {
  const Vec2 p = v.visitor.camera.view.position;
  const Vec2 way = WayStraightOrRound(v.town.walkable, p, v.visitor.tour.stops[HaltOf(v.visitor.tour)].position_m,
                                      &v.visitor.tour.corner, &v.town.crowd.search);
  if (Length(way) < 0.5f) return;
  TurnForTour(std::atan2(way.y, way.x), v);
  Walk(RoundPeople(v, way), TourSpeed_mps(v), v);
}

void FollowTour(const CameraInput& input, const VisitorInTown& v) {
  GuidedTour& t = v.visitor.tour;
  const Vec2 p = v.visitor.camera.view.position;
  LookAbout(input, v);
  if (!t.begun) return;
  if (t.resting && Length(t.stops[HaltOf(t)].position_m - p) < kAtHalt_m) {
    const float look_rad = t.stops[HaltOf(t)].yaw_rad.value_or(0);
    StirLoiterers(p + DirectionOf(look_rad) * kBeforeSight_m, kBeforeSightRadius_m, &v.town);
    return TurnBeside(look_rad, kMostAsideAtHalt_rad, v);
  }
  if (t.over) return TurnForTour(LookOfLeave_rad(v.visitor.camera.view.yaw_rad, v), v);
  if (t.paused) return;
  if (t.resting) return ReturnToHalt(v);
  const Vec2 way = WayAlong(v.town.walkable, t.route, t.visitor_m, p, &t.corner, &v.town.crowd.search);
  if (v.visitor.stuck_s > kGiveUp_s || Length(way) < 0.5f) {
    v.visitor.stuck_s = 0;
    return GiveUpStop(v);
  }
  const float pace = ShareOfPace(v);
  const Vec2 look = PointAt(t.route, t.visitor_m + kLooksAhead_m) - p;
  const float look_rad = AngleOf(look) + LookOffWay_rad(AngleOf(look), v);
  if (pace > kStands && Length(look) > kReached_m) TurnBeside(look_rad, kMostAside_rad, v);
  else if (pace <= kStands) LookAfterGuide(v);
  // Turns first, then walks: but for who looks about.
  const float ahead = v.visitor.looks_about_s > 0 ? 1 : std::cos(v.visitor.camera.view.yaw_rad - look_rad);
  const float behind = PaceBehind(v, way);
  if (pace > kStands)
    Walk(RoundPeople(v, StepAside(v, way)), TourSpeed_mps(v) * pace * std::min(behind, std::max(kSideways, ahead)), v);
  else v.visitor.stuck_s = 0;
}

void Fly(const FlyingCamera& to, const VisitorInTown& v) {
  CameraState& camera = v.visitor.camera;
  camera.flies = true;
  camera.velocity = (to.position - camera.view.position) * (1 / Step_s(v.settings));
  camera.actual_mps = Length(camera.velocity);
  camera.view.position = v.visitor.stuck_at = to.position;
  camera.eye_height_m = to.eye_height_m;
  if (!to.yaw_rad) return;  // leaps there
  camera.view.yaw_rad = *to.yaw_rad;
  camera.velocity = {};
  camera.actual_mps = 0;
}

// Where another run's visitor has gone.
void GoAs(const Visitor& other, Visitor* visitor) {
  const CameraState own = visitor->camera;
  visitor->camera = other.camera;
  visitor->camera.aspect = own.aspect;
  visitor->camera.present = own.present;
  visitor->leg = other.leg;
  visitor->stuck_s = other.stuck_s;
  visitor->finished = other.finished;
}

}  // namespace

void MoveCamera(const CameraInput& input, const VisitorInTown& town) {
  const VisitorInTown v{town.settings, town.town, town.visitor, input.minds};
  CameraState& camera = v.visitor.camera;
  camera.velocity = camera.asked_velocity = {};
  camera.yaw_rate_radps = camera.asked_mps = camera.actual_mps = 0;
  camera.flies = false;
  if (!camera.present) return;
  if (input.pitch_rad) camera.pitch_rad = *input.pitch_rad;
  if (input.walk_to) SetOut(*input.walk_to, v);
  if (!input.active || input.speed_mps > 0) v.visitor.point_walk = {};
  if (input.active) {
    v.visitor.looks_about_s = 0;
    TurnCamera(input.yaw_rate_radps, v);
    if (input.flies) return Fly(*input.flies, v);
    if (input.speed_mps > 0) Walk(input.direction, input.speed_mps, v);
    else if (!v.visitor.point_walk.route.points.empty()) FollowPoint(input.walk_to_mps, input.yaw_rate_radps != 0, v);
    if (!v.visitor.point_walk.route.points.empty() && v.visitor.stuck_s >= kPatience_s)
      StirLoiterers(camera.view.position, kLoitererYieldRadius_m, &v.town);
    return;
  }
  if (v.visitor.finished && !v.visitor.tour.over) return;
  if (input.as != nullptr) GoAs(*input.as, &v.visitor);
  else if (!v.visitor.legs.empty()) FollowLegs(v);
  else if (!v.visitor.tour.stops.empty()) FollowTour(input, v);
  if (v.visitor.stuck_s >= kPatience_s) StirLoiterers(camera.view.position, kLoitererYieldRadius_m, &v.town);
}

}  // namespace flaneur
