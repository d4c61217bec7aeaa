#include "runtime/town/loitering.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/fast_math.h"
#include "runtime/town/company.h"
#include "runtime/town/courtesy.h"
#include "runtime/town/places.h"
#include "runtime/town/ways_out.h"

namespace flaneur {
namespace {

constexpr float kMinWait_s = 15, kMaxWait_s = 50;
constexpr int kLookEvery_steps = 10;
constexpr float kClaim_m = 2.5f;  // so near a place people look for a spot
constexpr float kPushedAside_m = 0.6f;
constexpr float kTalkReach_m = 1.5f;  // between spots
constexpr float kLooksFor_m = 3;
constexpr float kTurnsAway_s = 9;           // mean time between looks at something or somebody else
constexpr float kTalks = 0.6f;              // share of the looks that go to somebody, where somebody is near
constexpr float kStaysOn = 0.7f;            // of those whose time is over while too few stand about
constexpr float kOnTheWay = 2;              // so many times those who should stand may plan to
constexpr float kMinSpotSpacing_m = 0.75f;  // between spots
// Along the look and to its left.
constexpr Vec2 kBeforeThing[] = {{0, 0}, {0, 0.85f}, {0, -0.85f}, {-0.85f, 0.45f}, {-0.85f, -0.45f}};
constexpr Vec2 kCircle[] = {{0.62f, 0}, {0, 0.62f}, {-0.62f, 0}, {0, -0.62f}};

// Something stands there to look at.
bool HasAhead(const Walkable& w, Vec2 p, Vec2 look) {
  for (float ahead_m = 0; ahead_m < kLooksFor_m; ahead_m += 0.5f * w.cell_m) {
    if (InsideObstacle(w, p + look * ahead_m)) return true;
  }
  return false;
}

void AddSpot(int place, Vec2 p, Vec2 look, Town* town) {
  const Vec2 center = town->places[static_cast<size_t>(place)].position_m;
  if (!IsFree(town->walkable, p) || !StraightWay(town->walkable, center, p)) return;
  if (town->crowd_area && !Contains(*town->crowd_area, p)) return;
  for (const LoiterSpot& other : town->loiter_spots) {
    if (Length(other.position_m - p) < kMinSpotSpacing_m) return;
  }
  LoiterSpot spot;
  spot.position_m = p, spot.look = look, spot.place = place;
  town->loiter_spots.push_back(spot);
}

LoiterSpot* SpotOf(size_t i, Town* town) {
  const int spot = PlanOf(i, town).spot;
  return spot >= 0 ? &town->loiter_spots[static_cast<size_t>(spot)] : nullptr;
}

float Standing(const Town& town) {
  return static_cast<float>(std::count_if(town.loiter_spots.begin(), town.loiter_spots.end(),
                                          [](const LoiterSpot& spot) { return spot.there; }));
}

// All of the company claim spots, or go elsewhere.
void Claim(size_t i, int place, const Viewer& viewer, Town* town) {
  const Company company = CompanyOf(town->crowd, i);
  int spots[kMaxGroupSize];
  if (!FindSpots(viewer, *town, place, town->crowd.position[i], company.size, spots)) {
    SendAll(company, PickDestination(viewer, town->crowd.position[i], false, town), town);
    return;
  }
  for (int k = 0; k < company.size; ++k) TakeSpot(company.member[k], spots[k], false, town);
}

void StandAt(size_t i, LoiterSpot* spot, Town* town) {
  Crowd& c = town->crowd;
  SetGoal(i, -1, &c);
  spot->there = true;
  c.facing[i] = spot->look;
  if (c.wait_s[i] <= 0) c.wait_s[i] = town->random.Uniform(kMinWait_s, kMaxWait_s);
}

// Somebody near to talk with: who talks to nobody yet first.
int FindPartner(const Town& town, int own) {
  const LoiterSpot& me = town.loiter_spots[static_cast<size_t>(own)];
  int best = -1;
  float best_m = kTalkReach_m;
  for (int k = 0; k < static_cast<int>(town.loiter_spots.size()); ++k) {
    const LoiterSpot& other = town.loiter_spots[static_cast<size_t>(k)];
    if (k == own || !other.there) continue;
    const float apart_m =
        Length(other.position_m - me.position_m) + (other.partner >= 0 && other.partner != own ? 0.5f : 0.0f);
    if (apart_m < best_m) best = k, best_m = apart_m;
  }
  return best;
}

void LookElsewhere(int own, Town* town) {
  LoiterSpot& me = town->loiter_spots[static_cast<size_t>(own)];
  me.partner = town->random.Uniform() < kTalks ? FindPartner(*town, own) : -1;
  if (me.partner < 0) return;
  LoiterSpot& other = town->loiter_spots[static_cast<size_t>(me.partner)];
  if (other.partner < 0) other.partner = own;  // who talks already keeps their partner: then three stand together
}

void Stand(size_t i, LoiterSpot* spot, float step_s, Town* town) {
  Crowd& c = town->crowd;
  const int own = PlanOf(i, town).spot;
  if (c.detour_s[i] > 0) {
    c.wait_s[i] = 0;
    return;
  }
  if (Length(c.position[i] - spot->position_m) > kPushedAside_m) {
    spot->there = false;
    SetGoal(i, FieldFor(spot->position_m, &c), &c);
    return;
  }
  if (town->random.Uniform() * kTurnsAway_s < step_s * kLookEvery_steps) LookElsewhere(own, town);
  const bool talks = spot->partner >= 0 && town->loiter_spots[static_cast<size_t>(spot->partner)].there;
  if (!talks) spot->partner = -1;
  c.activity[i] = talks ? Activity::kTalking : Activity::kStanding;
  c.facing[i] =
      talks ? Unit(town->loiter_spots[static_cast<size_t>(spot->partner)].position_m - c.position[i]) : spot->look;
}

}  // namespace

void PrepareLoitering(Town* town) {
  town->loiter_spots.clear();
  for (int place : town->place_lists.loiters) {
    const Place& at = town->places[static_cast<size_t>(place)];
    if (!at.yaw_rad) {
      for (const Vec2 p : kCircle) AddSpot(place, at.position_m + p, Unit(p * -1), town);
      continue;
    }
    const Vec2 look{std::cos(*at.yaw_rad), std::sin(*at.yaw_rad)}, left{-look.y, look.x};
    const bool anything = HasAhead(town->walkable, at.position_m, look);
    for (const Vec2 p : kBeforeThing) {
      const Vec2 spot = at.position_m + look * p.x + left * p.y;
      if (!anything || HasAhead(town->walkable, spot, look))
        AddSpot(place, spot, look, town);  // not before the gap between two stalls
    }
  }
}

void PlanToLoiter(size_t i, Town* town) {
  PersonPlan& plan = PlanOf(i, town);
  if (!plan.loiters) ++town->loiterers;
  plan.loiters = true;
}

void StopLoitering(size_t i, Town* town) {
  PersonPlan& plan = PlanOf(i, town);
  if (plan.loiters) --town->loiterers;
  plan.loiters = false;
  if (plan.spot < 0) return;
  LoiterSpot& spot = town->loiter_spots[static_cast<size_t>(plan.spot)];
  spot.taken = spot.there = false;
  spot.partner = plan.spot = -1;
  town->crowd.wait_s[i] = 0;
  town->crowd.facing[i] = {};
}

bool FewLoiter(const Town& town) {
  const float wanted = town.settings.loiter_share * static_cast<float>(town.target_people);
  return static_cast<float>(town.loiterers) < kOnTheWay * wanted && Standing(town) < wanted;
}

void StirLoiterers(Vec2 p, float reach_m, Town* town) {
  for (size_t i = 0; i < town->crowd.size(); ++i) {
    if (Length(town->crowd.position[i] - p) < reach_m) town->crowd.wait_s[i] = 0;
  }
}

bool StaysOn(size_t i, const Viewer& viewer, Town* town) {
  const LoiterSpot* spot = SpotOf(i, town);
  if (spot == nullptr || !spot->there || town->crowd.detour_s[i] > 0 || IsFullNear(viewer, *town, spot->position_m) ||
      IsBeforeEyes(viewer, spot->position_m))
    return false;
  const float wanted = town->settings.loiter_share * static_cast<float>(town->target_people);
  if (Standing(*town) > wanted || town->random.Uniform() >= kStaysOn) return false;
  town->crowd.wait_s[i] = town->random.Uniform(kMinWait_s, kMaxWait_s);
  return true;
}

bool FindSpots(const Viewer& viewer, const Town& town, int place, Vec2 from, int count, int* spots) {
  int found = 0;
  for (; found < count; ++found) {
    int best = -1;
    float best_m = 0;
    for (int k = 0; k < static_cast<int>(town.loiter_spots.size()); ++k) {
      const LoiterSpot& spot = town.loiter_spots[static_cast<size_t>(k)];
      if (spot.place != place || spot.taken || IsBeforeEyes(viewer, spot.position_m) ||
          std::find(spots, spots + found, k) != spots + found)
        continue;
      const float away_m = Length(spot.position_m - from);
      if (best < 0 || away_m < best_m) best = k, best_m = away_m;
    }
    if (best < 0) return false;
    spots[found] = best;
  }
  return true;
}

void TakeSpot(size_t i, int which, bool now, Town* town) {
  PlanToLoiter(i, town);
  LoiterSpot& spot = town->loiter_spots[static_cast<size_t>(which)];
  spot.taken = true;
  PlanOf(i, town).spot = which;
  if (now) StandAt(i, &spot, town);
  else SetGoal(i, FieldFor(spot.position_m, &town->crowd), &town->crowd);
}

void StepLoitering(const Viewer& viewer, Town* town) {
  Crowd& c = town->crowd;
  for (size_t i = static_cast<size_t>(town->step % kLookEvery_steps); i < c.size(); i += kLookEvery_steps) {
    if (!PlanOf(i, town).loiters) continue;
    LoiterSpot* spot = SpotOf(i, town);
    if (spot != nullptr && c.field[i] >= 0 && c.arrived[i] == Arrival::kThere) StandAt(i, spot, town);
    if (spot != nullptr && c.field[i] < 0) Stand(i, spot, Step_s(viewer.settings), town);
    if (spot != nullptr || c.field[i] < 0) continue;
    const Vec2 goal = c.fields[static_cast<size_t>(c.field[i])].goal;
    if (Length(goal - c.position[i]) < kClaim_m) Claim(i, PlaceOfField(c.field[i], town), viewer, town);
  }
}

}  // namespace flaneur
