#include "runtime/walk/guide.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/fast_math.h"
#include "runtime/town/loitering.h"
#include "runtime/town/population.h"
#include "runtime/walk/visitor.h"

namespace flaneur {
namespace {

constexpr float kLead_m = 3.6f;        // along the route, before the visitor
constexpr float kCatchesUp_ps = 0.9f;  // metres a second for each metre that the lead is short of that
constexpr float kSetsOff_mps = 0.4f, kStops_mps = 0.15f;
constexpr float kWaits_m = 7;     // a visitor farther than this has to come first
constexpr float kNearHalt_m = 3;  // from the route's end the guide goes to where to stand there
constexpr float kOffPlace_m = 0.5f, kAtPlace_m = 0.15f;
constexpr float kToPlace_mps = 1.3f;
constexpr float kAhead_m = 0.8f, kFullPace_m = 2.0f;  // lead with which the visitor begins to walk, and walks as usual
constexpr float kPatience_s = 4;                      // of a visitor who waits for the guide to get ahead
constexpr float kBesideView_rad = 0.32f;              // to the side of what there is to see at a halt
constexpr float kRoom_m = 0.25f;                      // and so much more where they have the choice
constexpr float kClears_m = 0.15f;                    // people keep so much more than touching from the guide
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

bool CanStand(const VisitorInTown& v, Vec2 stop, Vec2 p) {
  return IsFree(v.town.walkable, p) && FreeLine(v.town.walkable, stop, p);
}

// Where the guide stands at a halt: beside what there is to see, near enough to be heard, never in the visitor's way.
Vec2 PlaceAt(const VisitorInTown& v, size_t halt) {
  const TourStop& stop = v.visitor.tour.stops[halt];
  const float looks_rad = LookAt_rad(v.visitor.tour, halt);
  const float least_m =
      v.settings.r_personal_m + v.town.residents[static_cast<size_t>(v.visitor.guide.avatar)].radius_m + 0.3f;
  for (const float wider : {1.0f, 1.8f, 3.0f, 5.0f, 0.0f, 7.0f}) {
    for (const float far_m : {std::max(2.8f, least_m), std::max(2.0f, least_m), least_m}) {
      for (const float side : {-1.0f, 1.0f}) {
        const Vec2 p = stop.position_m + DirectionOf(looks_rad + side * wider * kBesideView_rad) * far_m;
        if (CanStand(v, stop.position_m, p)) return p;
      }
    }
  }
  return stop.position_m;
}

void FollowPlan(Vec2 p, const VisitorInTown& v) {
  Guide& g = v.visitor.guide;
  const GuidedTour& t = v.visitor.tour;
  if (g.plans == t.plans) {
    g.way_m = WayTo(t.route, p, g.way_m - 1, g.way_m + 3);
    return;
  }
  g.plans = t.plans;
  g.place = PlaceAt(v, HaltOf(t));
  g.way_m = WayTo(t.route, p, 0, kFarthest_m);
  g.waited_s = 0;
}

bool GoesToPlace(const VisitorInTown& v) {
  return v.visitor.tour.resting || v.visitor.tour.over ||
         LengthOf_m(v.visitor.tour.route) - v.visitor.guide.way_m < kNearHalt_m;
}

// Speed along the route: the visitor's own, and what the lead asks for.
float LeadingSpeed_mps(const VisitorInTown& v, Vec2 p) {
  const bool far = Length(p - v.visitor.camera.view.position) > kWaits_m;
  const float lead_m = v.visitor.guide.way_m - v.visitor.tour.visitor_m;
  if (v.visitor.tour.paused || (far && (lead_m > kLead_m || !v.visitor.tour.follows))) return 0;
  const Vec2 ahead = PointAt(v.visitor.tour.route, v.visitor.tour.visitor_m + 1) -
                     PointAt(v.visitor.tour.route, v.visitor.tour.visitor_m);
  const float ahead_m = Length(ahead);
  const float visitor_mps = ahead_m > 1e-3f ? std::max(0.0f, Dot(v.visitor.camera.velocity, ahead) / ahead_m) : 0;
  return std::clamp(visitor_mps + kCatchesUp_ps * (kLead_m - lead_m), 0.0f, v.town.settings.top_speed_mps);
}

Vec2 Wanted(Vec2 p, const VisitorInTown& v) {
  Guide& g = v.visitor.guide;
  if (GoesToPlace(v)) {
    const float left_m = Length(g.place - p);
    g.walks = left_m > (g.walks ? kAtPlace_m : kOffPlace_m);
    if (!g.walks) return {};
    return WayStraightOrRound(v.town.walkable, p, g.place, &g.corner, &v.town.crowd.search) *
           std::min(kToPlace_mps, kStops_mps + 1.5f * left_m);
  }
  const float speed_mps = LeadingSpeed_mps(v, p);
  g.walks = speed_mps > (g.walks ? kStops_mps : kSetsOff_mps);
  if (!g.walks) return {};
  return WayAlong(v.town.walkable, v.visitor.tour.route, g.way_m, p, &g.corner, &v.town.crowd.search) * speed_mps;
}

// Who stands in the way of a guide who cannot get on walks off.
void GetOn(Vec2 p, const VisitorInTown& v) {
  Guide& g = v.visitor.guide;
  const bool got_on = !g.walks || Length(p - g.stuck_at) > kGetsOn_m;
  g.stuck_s = got_on ? 0 : g.stuck_s + Step_s(v.settings);
  if (got_on) g.stuck_at = p;
  if (g.stuck_s >= kStuck_s) StirLoiterers(p, kLoitererYieldRadius_m, &v.town);
}

float OwnShareOfPace(const VisitorInTown& v) {
  const Guide& g = v.visitor.guide;
  if (GoesToPlace(v) || Length(v.town.crowd.position[g.index] - v.visitor.camera.view.position) > kWaits_m) return 1;
  return std::clamp((g.way_m - v.visitor.tour.visitor_m - kAhead_m) / (kFullPace_m - kAhead_m), 0.0f, 1.0f);
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
  for (const float ahead_m : {kLead_m, 2.5f, 4.0f, 2.0f, 5.0f, 1.5f}) {
    *start = PointAt(v.visitor.tour.route, ahead_m);
    if (fits(*start)) return true;
  }
  *start = PlaceAt(v, HaltOf(v.visitor.tour));
  if (Length(*start - visitor) < kWaits_m && fits(*start)) return true;
  const int cell =
      NearestFreeCell(v.town.walkable, visitor + DirectionOf(v.visitor.camera.view.yaw_rad) * kLead_m, kLead_m);
  if (cell >= 0) *start = CellCenter(v.town.walkable, cell);
  return cell >= 0 && fits(*start);
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
  g.velocity = Wanted(p, v);
  GetOn(p, v);
  g.waited_s = OwnShareOfPace(v) < 0.3f ? g.waited_s + Step_s(v.settings) : 0;
  const Vec2 to_visitor = v.visitor.camera.view.position - p;
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
  moving->push_back(
      {v.town.crowd.position[i], v.town.crowd.radius_m[i] + kClears_m, true, v.visitor.guide.velocity, kRoom_m});
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
