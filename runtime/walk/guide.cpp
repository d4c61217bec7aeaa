#include "runtime/walk/guide.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/fast_math.h"
#include "runtime/town/loitering.h"
#include "runtime/town/population.h"
#include "runtime/walk/staging.h"
#include "runtime/walk/step_aside.h"
#include "runtime/walk/visitor.h"

namespace flaneur {
namespace {

constexpr float kCatchesUp_ps = 0.9f;  // metres a second for each metre that the lead is short of that
constexpr float kSetsOff_mps = 0.4f, kStops_mps = 0.15f;
constexpr float kWaits_m = 4;  // a visitor so much farther than the lead has to come first
// From the route's end the guide goes to where to stand there, and, as that may lie back beside the route, on to it
// from so far.
constexpr float kNearHalt_m = 3, kGoesOnToPlace_m = 12;
constexpr float kOffPlace_m = 0.5f, kAtPlace_m = 0.15f;
constexpr float kToPlace_mps = 1.6f, kComesToStand_s = 0.3f;
constexpr float kAhead = 0.5f,
                kFullPace = 0.85f;   // of the lead, with which the visitor begins to walk, and walks as usual
constexpr float kPatience_s = 8;     // of a visitor who waits for the guide to get ahead
constexpr float kWalkedTo_m = 1.2f;  // along the route
constexpr float kLeadsOn = 0.3f;     // cosine of the angle from it
constexpr float kOnRoute_s = 0.8f;
constexpr int kChooseSideEvery_steps = 15;
constexpr float kClearlyBeside_rad = 0.1f;  // of the picture's middle
constexpr float kClears_m = 0.15f;          // people keep so much more than touching from the guide
constexpr float kRoom_m = 0.25f;            // and so much more where they have the choice
constexpr float kMeets_m = 6;               // a visitor who is nearer
constexpr float kTalks_m = 10;              // to a visitor who is no farther
constexpr float kStuck_s = 1.5f, kGetsOn_m = 0.5f, kLoitererYieldRadius_m = 1.6f;
constexpr float kFarthest_m = 20;  // of a new route the guide is looked for so far

bool Find(const VisitorInTown& v) {
  Guide& g = v.visitor.guide;
  if (g.id < 0) return false;
  if (g.index < v.town.crowd.size() && v.town.crowd.id[g.index] == g.id) return true;
  g.index =
      static_cast<size_t>(std::find(v.town.crowd.id.begin(), v.town.crowd.id.end(), g.id) - v.town.crowd.id.begin());
  return g.index < v.town.crowd.size();
}

// Along the route, before the visitor.
float Lead_m(const VisitorInTown& v) { return LeadDepth_m(v.visitor.camera); }

bool IsFar(const VisitorInTown& v, Vec2 p) { return Length(p - v.visitor.camera.view.position) > Lead_m(v) + kWaits_m; }

void FollowPlan(Vec2 p, const VisitorInTown& v) {
  Guide& g = v.visitor.guide;
  const GuidedTour& t = v.visitor.tour;
  if (g.plans == t.plans) {
    g.way_m = WayTo(t.route, p, g.way_m - 1, g.way_m + 3);
    return;
  }
  g.plans = t.plans;
  g.goes_to_place = false;
  g.way_m = WayTo(t.route, p, 0, kFarthest_m);
  g.waited_s = 0;
  g.side = SideToWalk(std::min(Lead_m(v), LengthOf_m(t.route)), 0, v);
  g.place = PlaceBesideSight(HaltOf(t), BesideRoute(LengthOf_m(t.route) - kNearHalt_m, g.side, v), v);
}

bool GoesToPlace(const VisitorInTown& v) {
  const GuidedTour& tour = v.visitor.tour;
  if (tour.resting || tour.over) return true;
  const size_t g = v.visitor.guide.index;
  const Vec2 p = v.town.crowd.position[g] + v.town.crowd.velocity[g] * kComesToStand_s;
  const float near_m = v.visitor.guide.goes_to_place ? kGoesOnToPlace_m : kNearHalt_m;
  return LengthOf_m(tour.route) - v.visitor.guide.way_m < near_m && !(tour.follows && IsFar(v, p));
}

// Speed along the route: the visitor's own, and what the lead asks for.
float LeadingSpeed_mps(const VisitorInTown& v, Vec2 p) {
  const bool far = IsFar(v, p);
  const float lead_m = v.visitor.guide.way_m - v.visitor.tour.visitor_m;
  if (v.visitor.tour.paused || !v.visitor.tour.begun || (far && (lead_m > Lead_m(v) || !v.visitor.tour.follows)))
    return 0;
  const Vec2 ahead = PointAt(v.visitor.tour.route, v.visitor.tour.visitor_m + 1) -
                     PointAt(v.visitor.tour.route, v.visitor.tour.visitor_m);
  const float ahead_m = Length(ahead);
  const float visitor_mps = ahead_m > 1e-3f ? std::max(0.0f, Dot(v.visitor.camera.velocity, ahead) / ahead_m) : 0;
  return std::clamp(visitor_mps + kCatchesUp_ps * (Lead_m(v) - lead_m), 0.0f, v.town.settings.top_speed_mps);
}

// To one side of the route, and on it for a while wherever that does not lead on.
Vec2 AlongRouteBeside(Vec2 p, const VisitorInTown& v) {
  Guide& g = v.visitor.guide;
  const Route& route = v.visitor.tour.route;
  g.on_route_s = std::max(0.0f, g.on_route_s - Step_s(v.settings));
  const Vec2 to = BesideRoute(g.way_m + kWalkedTo_m, g.side, v) - p;
  const Vec2 on = PointAt(route, g.way_m + kWalkedTo_m) - PointAt(route, g.way_m);
  const bool leads_on = Length(to) > kAtPlace_m && Dot(to, on) > kLeadsOn * Length(to) * Length(on);
  if (!leads_on || !FreeLine(v.town.walkable, p, p + to)) g.on_route_s = kOnRoute_s;
  if (g.on_route_s <= 0) return Unit(to);
  return WayAlong(v.town.walkable, route, g.way_m, p, &g.corner, &v.town.crowd.search);
}

// Who would have to get past the visitor to their place, in a lane that is too narrow for it, goes before them until it
// widens. Zero: nothing of the kind.
Vec2 KeepsBefore(Vec2 p, const VisitorInTown& v) {
  const Vec2 visitor = v.visitor.camera.view.position, off = p - visitor, to_place = v.visitor.guide.place - p;
  const float far_m = Length(off);
  const bool leads = v.visitor.guide.way_m > v.visitor.tour.visitor_m;
  if (!leads || far_m > kMeets_m || far_m <= 0 || Dot(to_place, off) >= 0) return {};
  const Vec2 away = off * (1 / far_m);
  const Vec2 way = AlongRoute(v.visitor.tour.route, v.visitor.tour.visitor_m);
  if (LetsPass(v, visitor, way, v.town.crowd.radius_m[v.visitor.guide.index])) return {};
  return away * std::max(Dot(v.visitor.camera.velocity, away), kStops_mps);
}

Vec2 Wanted(Vec2 p, const VisitorInTown& v) {
  Guide& g = v.visitor.guide;
  if (g.goes_to_place) {
    if (const Vec2 before = KeepsBefore(p, v); Length(before) > 0) {
      g.walks = true;
      return before;
    }
    const float left_m = Length(g.place - p);
    g.walks = left_m > (g.walks ? kAtPlace_m : kOffPlace_m);
    if (!g.walks) return {};
    return WayStraightOrRound(v.town.walkable, p, g.place, &g.corner, &v.town.crowd.search) *
           std::min(kToPlace_mps, kStops_mps + 1.5f * left_m);
  }
  const float speed_mps = LeadingSpeed_mps(v, p);
  g.walks = speed_mps > (g.walks ? kStops_mps : kSetsOff_mps);
  if (!g.walks) return {};
  if (v.town.step % kChooseSideEvery_steps == 0) g.side = SideToWalk(g.way_m, g.side, v);
  return AlongRouteBeside(p, v) * speed_mps;
}

// Who stands in the way of a guide who cannot get on walks off.
void GetOn(Vec2 p, const VisitorInTown& v) {
  Guide& g = v.visitor.guide;
  const bool got_on = !g.walks || Length(p - g.stuck_at) > kGetsOn_m;
  g.stuck_s = got_on ? 0 : g.stuck_s + Step_s(v.settings);
  if (got_on) g.stuck_at = p;
  if (g.stuck_s >= kStuck_s) StirLoiterers(p, kLoitererYieldRadius_m, &v.town);
}

// Where the guide is going to stand while the visitor rests, else where they are.
void NoteSideInPicture(Vec2 p, const VisitorInTown& v) {
  Guide& g = v.visitor.guide;
  const GuidedTour& t = v.visitor.tour;
  const ViewCamera& view = v.visitor.camera.view;
  const float at_rad = t.resting ? WrapAngle(AngleOf(g.place - view.position) - LookAt_rad(t, HaltOf(t)))
                                 : WrapAngle(AngleOf(p - view.position) - view.yaw_rad);
  if (std::abs(at_rad) > kClearlyBeside_rad && std::abs(at_rad) < view.fov_rad / 2) g.is_left = at_rad > 0;
}

// Where the visitor was, is or soon will be the guide does not get past.
bool IsInNarrowLane(const VisitorInTown& v) {
  const GuidedTour& t = v.visitor.tour;
  const float radius_m = v.town.crowd.radius_m[v.visitor.guide.index];
  for (const float ahead_m : {-0.9f, 0.0f, 0.7f, 1.4f}) {
    const float way_m = t.visitor_m + ahead_m;
    if (!LetsPass(v, PointAt(t.route, way_m), AlongRoute(t.route, way_m), radius_m)) return true;
  }
  return false;
}

float OwnShareOfPace(const VisitorInTown& v) {
  const Guide& g = v.visitor.guide;
  if (GoesToPlace(v) || IsFar(v, v.town.crowd.position[g.index])) return 1;
  const float lead = (g.way_m - v.visitor.tour.visitor_m) / Lead_m(v);
  if (lead <= 0 && IsInNarrowLane(v)) return 1;  // the guide comes after until there is room
  return std::clamp((lead - kAhead) / (kFullPace - kAhead), 0.0f, 1.0f);
}

// The free place nearest to the way that the tour begins with, a few steps ahead.
bool FindStart(const VisitorInTown& v, Vec2* start) {
  const Vec2 visitor = v.visitor.camera.view.position;
  const float least_m =
      v.settings.r_personal_m + v.town.residents[static_cast<size_t>(v.visitor.guide.avatar)].radius_m + 0.3f;
  const auto fits = [&](Vec2 p) {
    if (!IsFree(v.town.walkable, p) || Length(p - visitor) < least_m) return false;
    for (size_t i = 0; i < v.town.crowd.size(); ++i) {
      if (Length(v.town.crowd.position[i] - p) < v.town.crowd.radius_m[i] + 0.4f) return false;
    }
    return true;
  };
  const float lead_m = Lead_m(v), side = SideToWalk(std::min(lead_m, LengthOf_m(v.visitor.tour.route)), 0, v);
  for (const float ahead_m : {lead_m, lead_m - 0.7f, lead_m + 0.7f, 4.0f, 3.0f, 2.0f, 1.5f}) {
    for (const float of_side : {side, -side}) {
      *start = BesideRoute(ahead_m, of_side, v);
      if (fits(*start)) return true;
    }
    *start = PointAt(v.visitor.tour.route, ahead_m);
    if (fits(*start)) return true;
  }
  *start = PlaceBesideSight(HaltOf(v.visitor.tour), visitor, v);
  if (!IsFar(v, *start) && fits(*start)) return true;
  const int cell =
      NearestFreeCell(v.town.walkable, visitor + DirectionOf(v.visitor.camera.view.yaw_rad) * lead_m, lead_m);
  if (cell >= 0) *start = CellCenter(v.town.walkable, cell);
  return cell >= 0 && fits(*start);
}

// Zero but at a halt.
Vec2 ToListener(Vec2 guide, const VisitorInTown& v) {
  const Vec2 visitor = v.visitor.camera.view.position - guide;
  const bool talks = v.visitor.tour.resting && !v.visitor.guide.walks && Length(visitor) < kTalks_m;
  return talks ? visitor : Vec2{};
}

}  // namespace

void PlaceGuide(const VisitorInTown& v) {
  Guide& g = v.visitor.guide;
  if (g.avatar < 0 || v.visitor.tour.stops.empty() || v.town.settings.people == 0) return;
  Person p;
  if (!FindStart(v, &p.position)) {
    v.town.warnings.push_back("there is no room for the guide where the tour begins; it goes without");
    return;
  }
  p.avatar = g.avatar;
  p.radius_m = v.town.residents[static_cast<size_t>(g.avatar)].radius_m;
  p.preferred_mps = v.town.settings.preferred_speed_mps;
  p.top_mps = v.town.settings.top_speed_mps;
  const Vec2 to_visitor = v.visitor.camera.view.position - p.position;
  p.heading_rad = AngleOf(to_visitor);
  g.index = v.town.crowd.size();
  AddToTown(p, PersonPlan{{}, true, true}, &v.town);
  g.id = v.town.crowd.id.back();
  FollowPlan(p.position, v);
}

void BringGuide(const VisitorInTown& v) {
  if (!Find(v)) return;
  Vec2 place;
  if (!FindStart(v, &place)) return;  // then the guide comes on foot
  v.town.crowd.position[v.visitor.guide.index] = place;
  v.town.crowd.velocity[v.visitor.guide.index] = {};
  FollowPlan(place, v);
}

float LookOfLeave_rad(float now_rad, const VisitorInTown& v) {
  return Find(v) ? AngleOf(v.town.crowd.position[v.visitor.guide.index] - v.visitor.camera.view.position) : now_rad;
}

void LeadOn(const VisitorInTown& v) {
  if (!Find(v)) return;
  Guide& g = v.visitor.guide;
  Crowd& c = v.town.crowd;
  const Vec2 p = c.position[g.index];
  FollowPlan(p, v);
  g.goes_to_place = GoesToPlace(v);
  g.velocity = Wanted(p, v);
  GetOn(p, v);
  g.waited_s = OwnShareOfPace(v) < 0.3f ? g.waited_s + Step_s(v.settings) : 0;
  const Vec2 to_visitor = v.visitor.camera.view.position - p;
  NoteSideInPicture(p, v);
  c.facing[g.index] = Unit(to_visitor);
  const bool talks = v.visitor.tour.resting && !v.visitor.tour.paused;
  c.activity[g.index] = g.walks ? Activity::kWalking : talks ? Activity::kTalking : Activity::kStanding;
  c.detour[g.index] = g.velocity;
  c.detour_s[g.index] = g.walks ? 2 * Step_s(v.settings) : 0;
  c.way[g.index] = {};
}

void ShieldGuide(const VisitorInTown& v, std::vector<MovingObstacle>* moving) {
  if (!Find(v)) return;
  const size_t i = v.visitor.guide.index;
  // Who is on a fresh detour is not sent on another.
  v.town.crowd.detour[i] = v.visitor.guide.velocity;
  v.town.crowd.detour_s[i] = 1e3f;
  const Vec2 place = v.town.crowd.position[i];
  moving->push_back(
      {place, v.town.crowd.radius_m[i] + kClears_m, true, v.visitor.guide.velocity, kRoom_m, {}, ToListener(place, v)});
}

void UnshieldGuide(const VisitorInTown& v) {
  if (!Find(v)) return;
  v.town.crowd.detour_s[v.visitor.guide.index] = 0;
  v.town.crowd.avoids_camera[v.visitor.guide.index] = 0;
}

float ShareOfPace(const VisitorInTown& v) {
  return v.visitor.guide.id < 0 || v.visitor.guide.waited_s > kPatience_s ? 1 : OwnShareOfPace(v);
}

}  // namespace flaneur
