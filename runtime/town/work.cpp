#include "runtime/town/work.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/crowd/walls.h"
#include "runtime/town/company.h"
#include "runtime/town/places.h"
#include "runtime/town/population.h"
#include "runtime/town/ways_out.h"

namespace flaneur {
namespace {

constexpr int kLookEvery_steps = 10;
constexpr float kAtPost_m = 0.03f;                   // who sits or sweeps beside the spot looks wrong
constexpr float kStands_mps = 0.02f;                 // who comes no nearer
constexpr float kPushedAside_m = 0.25f;              // so far they come back as they came
constexpr float kNearEnough_m = 0.6f;                // where no way leads nearer, they step there
constexpr float kGap_m = 0.7f;                       // between people at the start, from middle to middle
constexpr float kMinShare = 0.5f, kMaxShare = 1.5f;  // of stay_s, that one stays
constexpr float kMinRest_s = 10, kMaxRest_s = 40;    // a place lies idle so long
constexpr float kFetch_m = 40;                       // who strolls within it may come to work

const Place& PlaceOf(const WorkSpot& spot, const Town& town) { return town.places[static_cast<size_t>(spot.place)]; }

bool NeedsNoClip(const std::string& clip) { return clip.empty() || clip == "idle" || clip == "talk"; }

// Which of the avatar's other clips it is; -1: none.
int ClipOf(const Resident& resident, const std::string& clip) {
  const auto found = std::find(resident.other_clips.begin(), resident.other_clips.end(), clip);
  return found != resident.other_clips.end() ? static_cast<int>(found - resident.other_clips.begin()) : -1;
}

bool IsNamed(const Resident& resident, const Place& place) {
  return std::find(place.avatars.begin(), place.avatars.end(), resident.avatar) != place.avatars.end();
}

// Those whom the tour names for it, though they may be nowhere else.
bool MayWork(const Resident& resident, const WorkSpot& spot, const Place& place) {
  if (resident.leads) return false;
  if (resident.radius_m > spot.room_m + 0.01f) return false;
  if (place.avatars.empty() ? resident.share <= 0 : !IsNamed(resident, place)) return false;
  return NeedsNoClip(place.clip) || ClipOf(resident, place.clip) >= 0;
}

// By their shares, or evenly among those who have none; -1: nobody.
int PickWorker(const WorkSpot& spot, Town* town) {
  const Place& place = PlaceOf(spot, *town);
  const auto& residents = town->residents;
  float total = 0;
  int able = 0;
  for (const Resident& resident : residents) {
    if (!MayWork(resident, spot, place)) continue;
    ++able;
    total += resident.share;
  }
  if (able == 0) return -1;
  float left = town->random.Uniform() * (total > 0 ? total : static_cast<float>(able));
  int last = -1;
  for (size_t k = 0; k < residents.size(); ++k) {
    if (!MayWork(residents[k], spot, place) || (total > 0 && residents[k].share <= 0)) continue;
    last = static_cast<int>(k);
    left -= total > 0 ? residents[k].share : 1;
    if (left < 0) break;
  }
  return last;
}

bool AnybodyAt(const Town& town, Vec2 p) {
  return std::any_of(town.crowd.position.begin(), town.crowd.position.end(),
                     [&](Vec2 other) { return Length(other - p) < kGap_m; });
}

int MostWorkers(float people, const Town& town) { return static_cast<int>(town.settings.work_share * people + 0.5f); }

void Begin(size_t i, WorkSpot* spot, Town* town) {
  Crowd& c = town->crowd;
  SetGoal(i, -1, &c);
  spot->there = true;
  c.wait_s[i] = 0;
  c.facing[i] = spot->look;
  c.post[i] = spot->position_m;
  c.activity[i] = Activity::kWorking;
}

// Whoever is there.
void DoWork(size_t i, const WorkSpot& spot, Town* town) {
  Crowd& c = town->crowd;
  const Resident& resident = town->residents[static_cast<size_t>(c.avatar[i])];
  const Place& place = PlaceOf(spot, *town);
  const int clip = ClipOf(resident, place.clip);
  c.doing[i] = static_cast<int8_t>(clip);
  c.sits[i] = clip >= 0 && (place.seat_m > 0 || resident.clip_sits[static_cast<size_t>(clip)]);
}

void Take(size_t i, int which, Town* town) {
  WorkSpot& spot = town->work_spots[static_cast<size_t>(which)];
  PlanOf(i, town).work = which;
  ++town->workers;
  spot.taken = true;
  spot.left_s = PlaceOf(spot, *town).stay_s * town->random.Uniform(kMinShare, kMaxShare);
}

void GoThere(size_t i, const WorkSpot& spot, Town* town) {
  SetGoal(i, FieldFor(spot.position_m, &town->crowd), &town->crowd);
}

void Work(size_t i, float passed_s, const Viewer& viewer, Town* town) {
  Crowd& c = town->crowd;
  WorkSpot& spot = town->work_spots[static_cast<size_t>(PlanOf(i, town).work)];
  const float away_m = Length(c.position[i] - spot.position_m);
  if (!spot.there) {
    if (c.field[i] < 0) GoThere(i, spot, town);
    const bool held_up = c.arrived[i] == Arrival::kNear && away_m < kNearEnough_m;
    if (c.arrived[i] == Arrival::kThere || held_up) Begin(i, &spot, town);
    return;
  }
  if (PlaceOf(spot, *town).stay_s > 0 && (spot.left_s -= passed_s) <= 0) {
    Send(i, PickDestination(viewer, c.position[i], false, town), town);
    return;
  }
  if (c.doing[i] < 0 && (away_m < kAtPost_m || Length(c.velocity[i]) < kStands_mps)) DoWork(i, spot, town);
  if (away_m > kPushedAside_m && Length(c.velocity[i]) < 0.05f && IsFree(town->walkable, spot.position_m)) {
    spot.there = false;
    GoThere(i, spot, town);
  }
}

bool IsAtLeisure(size_t i, const Town& town) {
  const PersonPlan& plan = PlanOf(i, town);
  const Crowd& c = town.crowd;
  return c.field[i] >= 0 && c.group[i] < 0 && c.detour_s[i] <= 0 && plan.goals.empty() && !plan.stay && !plan.leaves &&
         !plan.loiters && plan.work < 0;
}

// The nearest who can do it.
void FetchWorker(int which, const Viewer& viewer, Town* town) {
  const WorkSpot& spot = town->work_spots[static_cast<size_t>(which)];
  if (town->workers >= MostWorkers(static_cast<float>(town->target_people), *town)) return;
  if (IsFullNear(viewer, *town, spot.position_m)) return;
  const Crowd& c = town->crowd;
  int best = -1;
  float best_m = kFetch_m;
  for (size_t i = 0; i < c.size(); ++i) {
    const float away_m = Length(c.position[i] - spot.position_m);
    if (away_m >= best_m || !IsAtLeisure(i, *town)) continue;
    if (!MayWork(town->residents[static_cast<size_t>(c.avatar[i])], spot, PlaceOf(spot, *town))) continue;
    best = static_cast<int>(i), best_m = away_m;
  }
  if (best < 0) return;
  Take(static_cast<size_t>(best), which, town);
  GoThere(static_cast<size_t>(best), spot, town);
}

}  // namespace

float RoomAt_m(const Walkable& w, Vec2 p) {
  if (InsideObstacle(w, p)) return 0;
  float room_m = 1e9f;
  for (const Walkable::Edge& e : w.edges) room_m = std::min(room_m, Length(p - NearestOnSegment(p, e.a, e.b)));
  for (const CircleObstacle& circle : w.circles) room_m = std::min(room_m, Length(p - circle.center) - circle.radius_m);
  return room_m;
}

void PrepareWork(Town* town) {
  town->work_spots.clear();
  for (int k : town->place_lists.works) {
    const Place& place = town->places[static_cast<size_t>(k)];
    WorkSpot spot;
    spot.position_m = place.position_m;
    const float yaw_rad = place.yaw_rad.value_or(0);
    spot.look = {std::cos(yaw_rad), std::sin(yaw_rad)};
    spot.place = k;
    spot.room_m = RoomAt_m(town->walkable, place.position_m);
    const bool anybody = std::any_of(town->residents.begin(), town->residents.end(),
                                     [&](const Resident& resident) { return MayWork(resident, spot, place); });
    if (anybody) town->work_spots.push_back(spot);
    else
      town->warnings.push_back("place '" + place.name + "': nobody can work there; no avatar has the clip '" +
                               place.clip + "' and the room");
  }
}

int PlaceWorkers(int wanted, const Viewer& viewer, Town* town) {
  std::vector<int> order;
  for (int k = 0; k < static_cast<int>(town->work_spots.size()); ++k) order.push_back(k);
  for (size_t k = order.size(); k > 1; --k)
    std::swap(order[k - 1], order[static_cast<size_t>(town->random.Below(static_cast<int>(k)))]);
  const int most = std::min(wanted, MostWorkers(static_cast<float>(wanted), *town));
  int placed = 0;
  for (const int which : order) {
    if (placed >= most) break;
    WorkSpot& spot = town->work_spots[static_cast<size_t>(which)];
    const float away_m = Length(spot.position_m - viewer.camera.position);
    if (AnybodyAt(*town, spot.position_m)) continue;
    if (viewer.present && away_m < viewer.settings.r_personal_m + kGap_m) continue;
    if (!HasRoomAtStart(viewer, *town, spot.position_m)) continue;
    const int avatar = PickWorker(spot, town);
    if (avatar < 0) continue;
    Person p = NewPersonOf(avatar, town);
    p.position = spot.position_m;
    p.heading_rad = std::atan2(spot.look.y, spot.look.x);
    AddToTown(p, PersonPlan{{}, false, false}, town);
    Take(town->crowd.size() - 1, which, town);
    Begin(town->crowd.size() - 1, &spot, town);
    DoWork(town->crowd.size() - 1, spot, town);
    ++placed;
  }
  return placed;
}

void StopWork(size_t i, Town* town) {
  PersonPlan& plan = PlanOf(i, town);
  if (plan.work < 0) return;
  --town->workers;
  WorkSpot& spot = town->work_spots[static_cast<size_t>(plan.work)];
  plan.work = -1;
  spot.taken = spot.there = false;
  spot.left_s = town->random.Uniform(kMinRest_s, kMaxRest_s);
  town->crowd.facing[i] = {};
}

void StepWork(const Viewer& viewer, Town* town) {
  if (town->work_spots.empty() || town->step % kLookEvery_steps != 0) return;
  const float passed_s = Step_s(viewer.settings) * kLookEvery_steps;
  for (size_t i = 0; i < town->crowd.size(); ++i) {
    if (PlanOf(i, town).work >= 0) Work(i, passed_s, viewer, town);
  }
  for (int k = 0; k < static_cast<int>(town->work_spots.size()); ++k) {
    WorkSpot& spot = town->work_spots[static_cast<size_t>(k)];
    if (!spot.taken && (spot.left_s -= passed_s) <= 0) FetchWorker(k, viewer, town);
  }
}

}  // namespace flaneur
