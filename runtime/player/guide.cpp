#include "runtime/player/guide.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/fast_math.h"
#include "runtime/player/loitering.h"
#include "runtime/player/population.h"
#include "runtime/player/simulation.h"

namespace flaneur {
namespace {

constexpr float kLead_m = 3.6f;            // along the route, before the visitor
constexpr float kCatchesUp_ps = 0.9f;      // metres a second for each metre that the lead is short of that
constexpr float kSetsOff_mps = 0.4f, kStops_mps = 0.15f;
constexpr float kWaits_m = 7;              // a visitor farther than this has to come first
constexpr float kNearHalt_m = 3;           // from the route's end the guide goes to where to stand there
constexpr float kOffPlace_m = 0.5f, kAtPlace_m = 0.15f;
constexpr float kToPlace_mps = 1.3f;
constexpr float kAhead_m = 0.8f, kFullPace_m = 2.0f;     // lead with which the visitor begins to walk, and walks as usual
constexpr float kPatience_s = 4;           // of a visitor who waits for the guide to get ahead
constexpr float kBesideView_rad = 0.32f;   // to the side of what there is to see at a halt
constexpr float kClears_m = 0.15f;         // people keep so much more than touching from the guide
constexpr float kStuck_s = 1.5f, kGetsOn_m = 0.5f, kStirs_m = 1.6f;
constexpr float kFarthest_m = 20;          // of a new route the guide is looked for so far

bool Find(Simulation* s) {
  Guide& g = s->guide;
  if (g.id < 0) return false;
  if (g.index < s->crowd.size() && s->crowd.id[g.index] == g.id) return true;
  g.index = static_cast<size_t>(std::find(s->crowd.id.begin(), s->crowd.id.end(), g.id) - s->crowd.id.begin());
  return g.index < s->crowd.size();
}

bool CanStand(const Simulation& s, Vec2 stop, Vec2 p) {
  return IsFree(s.walkable, p) && FreeLine(s.walkable, stop, p);
}

// Where the guide stands at a halt: beside what there is to see, near enough to be heard, never in the visitor's way.
Vec2 PlaceAt(const Simulation& s, size_t halt) {
  const TourStop& stop = s.tour.stops[halt];
  const float looks_rad = LookAt_rad(s.tour, halt);
  const float least_m = s.r_personal_m + s.avatar_radius_m[static_cast<size_t>(s.guide.avatar)] + 0.3f;
  for (const float wider : {1.0f, 1.8f, 3.0f, 5.0f, 0.0f, 7.0f}) {
    for (const float far_m : {std::max(2.8f, least_m), std::max(2.0f, least_m), least_m}) {
      for (const float side : {-1.0f, 1.0f}) {
        const Vec2 p = stop.position_m + DirectionOf(looks_rad + side * wider * kBesideView_rad) * far_m;
        if (CanStand(s, stop.position_m, p)) return p;
      }
    }
  }
  return stop.position_m;
}

void FollowPlan(Vec2 p, Simulation* s) {
  Guide& g = s->guide;
  const Tour& t = s->tour;
  if (g.plans == t.plans) {
    g.way_m = WayTo(t.route, p, g.way_m - 1, g.way_m + 3);
    return;
  }
  g.plans = t.plans;
  g.place = PlaceAt(*s, HaltOf(t));
  g.way_m = WayTo(t.route, p, 0, kFarthest_m);
  g.waited_s = 0;
}

bool GoesToPlace(const Simulation& s) {
  return s.tour.resting || s.tour.over || LengthOf_m(s.tour.route) - s.guide.way_m < kNearHalt_m;
}

// Speed along the route: the visitor's own, and what the lead asks for.
float LeadingSpeed_mps(const Simulation& s, Vec2 p) {
  const bool far = Length(p - s.camera.view.position) > kWaits_m;
  const float lead_m = s.guide.way_m - s.tour.visitor_m;
  if (s.tour.paused || (far && (lead_m > kLead_m || !s.tour.follows))) return 0;
  const Vec2 ahead = PointAt(s.tour.route, s.tour.visitor_m + 1) - PointAt(s.tour.route, s.tour.visitor_m);
  const float ahead_m = Length(ahead);
  const float visitor_mps = ahead_m > 1e-3f ? std::max(0.0f, Dot(s.camera.velocity, ahead) / ahead_m) : 0;
  return std::clamp(visitor_mps + kCatchesUp_ps * (kLead_m - lead_m), 0.0f, s.crowd_settings.top_speed_mps);
}

Vec2 Wanted(Vec2 p, Simulation* s) {
  Guide& g = s->guide;
  if (GoesToPlace(*s)) {
    const float left_m = Length(g.place - p);
    g.walks = left_m > (g.walks ? kAtPlace_m : kOffPlace_m);
    if (!g.walks) return {};
    return WayStraightOrRound(s->walkable, p, g.place, &g.corner, &s->crowd.search) * std::min(kToPlace_mps, kStops_mps + 1.5f * left_m);
  }
  const float speed_mps = LeadingSpeed_mps(*s, p);
  g.walks = speed_mps > (g.walks ? kStops_mps : kSetsOff_mps);
  if (!g.walks) return {};
  return WayAlong(s->walkable, s->tour.route, g.way_m, p, &g.corner, &s->crowd.search) * speed_mps;
}

// Who stands in the way of a guide who cannot get on walks off.
void GetOn(Vec2 p, Simulation* s) {
  Guide& g = s->guide;
  const bool got_on = !g.walks || Length(p - g.stuck_at) > kGetsOn_m;
  g.stuck_s = got_on ? 0 : g.stuck_s + s->step_s;
  if (got_on) g.stuck_at = p;
  if (g.stuck_s >= kStuck_s) StirLoiterers(p, kStirs_m, s);
}

float OwnShareOfPace(const Simulation& s) {
  const Guide& g = s.guide;
  if (GoesToPlace(s) || Length(s.crowd.position[g.index] - s.camera.view.position) > kWaits_m) return 1;
  return std::clamp((g.way_m - s.tour.visitor_m - kAhead_m) / (kFullPace_m - kAhead_m), 0.0f, 1.0f);
}

// The free place nearest to the way that the tour begins with, a few steps ahead.
bool FindStart(const Simulation& s, Vec2* start) {
  const Vec2 visitor = s.camera.view.position;
  const float least_m = s.r_personal_m + s.avatar_radius_m[static_cast<size_t>(s.guide.avatar)] + 0.3f;
  const auto fits = [&](Vec2 p) {
    if (!IsFree(s.walkable, p) || Length(p - visitor) < least_m) return false;
    for (size_t i = 0; i < s.crowd.size(); ++i) {
      if (Length(s.crowd.position[i] - p) < s.crowd.radius_m[i] + 0.4f) return false;
    }
    return true;
  };
  for (const float ahead_m : {kLead_m, 2.5f, 4.0f, 2.0f, 5.0f, 1.5f}) {
    *start = PointAt(s.tour.route, ahead_m);
    if (fits(*start)) return true;
  }
  *start = PlaceAt(s, HaltOf(s.tour));
  if (Length(*start - visitor) < kWaits_m && fits(*start)) return true;
  const int cell = NearestFreeCell(s.walkable, visitor + DirectionOf(s.camera.view.yaw_rad) * kLead_m, kLead_m);
  if (cell >= 0) *start = CellCenter(s.walkable, cell);
  return cell >= 0 && fits(*start);
}

}  // namespace

void PlaceGuide(Simulation* s) {
  Guide& g = s->guide;
  if (g.avatar < 0 || s->tour.stops.empty() || s->crowd_settings.people == 0) return;
  Person p;
  if (!FindStart(*s, &p.position)) {
    s->warnings.push_back("there is no room for the guide where the tour begins; it goes without");
    return;
  }
  p.avatar = g.avatar;
  p.radius_m = s->avatar_radius_m[static_cast<size_t>(g.avatar)];
  p.preferred_mps = s->crowd_settings.preferred_speed_mps;
  p.top_mps = s->crowd_settings.top_speed_mps;
  const Vec2 to_visitor = s->camera.view.position - p.position;
  p.heading_rad = AngleOf(to_visitor);
  g.index = s->crowd.size();
  AddToTown(p, PersonPlan{{}, true, true}, s);
  g.id = s->crowd.id.back();
  s->level_settings.first_id = g.id;
  FollowPlan(p.position, s);
}

void BringGuide(Simulation* s) {
  if (!Find(s)) return;
  Vec2 place;
  if (!FindStart(*s, &place)) return;  // then the guide comes on foot
  s->crowd.position[s->guide.index] = place;
  s->crowd.velocity[s->guide.index] = {};
  FollowPlan(place, s);
}

float LookOfLeave_rad(float now_rad, Simulation* s) {
  return Find(s) ? AngleOf(s->crowd.position[s->guide.index] - s->camera.view.position) : now_rad;
}

void LeadOn(Simulation* s) {
  if (!Find(s)) return;
  Guide& g = s->guide;
  Crowd& c = s->crowd;
  const Vec2 p = c.position[g.index];
  FollowPlan(p, s);
  g.velocity = Wanted(p, s);
  GetOn(p, s);
  g.waited_s = OwnShareOfPace(*s) < 0.3f ? g.waited_s + s->step_s : 0;
  const Vec2 to_visitor = s->camera.view.position - p;
  c.facing[g.index] = Unit(to_visitor);
  const bool talks = s->tour.resting && !s->tour.paused;
  c.activity[g.index] = g.walks ? Activity::kWalking : talks ? Activity::kTalking : Activity::kStanding;
  c.detour[g.index] = g.velocity;
  c.detour_s[g.index] = g.walks ? 2 * s->step_s : 0;
  c.way[g.index] = {};
}

void ShieldGuide(Simulation* s) {
  if (!Find(s)) return;
  const size_t i = s->guide.index;
  // Who is on a fresh detour is not sent on another.
  s->crowd.detour[i] = s->guide.velocity;
  s->crowd.detour_s[i] = 1e3f;
  s->moving.push_back({s->crowd.position[i], s->crowd.radius_m[i] + kClears_m, true, s->guide.velocity});
}

void UnshieldGuide(Simulation* s) {
  if (!Find(s)) return;
  s->crowd.detour_s[s->guide.index] = 0;
  s->crowd.avoids_camera[s->guide.index] = 0;
}

float ShareOfPace(const Simulation& s) {
  return s.guide.id < 0 || s.guide.waited_s > kPatience_s ? 1 : OwnShareOfPace(s);
}

}  // namespace flaneur
