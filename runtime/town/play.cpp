#include "runtime/town/play.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/fast_math.h"
#include "runtime/crowd/flow_field.h"
#include "runtime/town/population.h"

namespace flaneur {
namespace {

constexpr int kLookEvery_steps = 5;
constexpr int kPoints = 8, kTries = 12;
constexpr float kMinRun_m = 2.5f;                   // from where they stand to where they run
constexpr float kMinRest_s = 0.3f, kMaxRest_s = 4;  // between two runs
constexpr float kHeldUp_s = 1.5f;                   // who does not get on for so long runs elsewhere
constexpr float kSlow_mps = 0.3f;
constexpr float kTop = 1.15f;  // of their pace, where they dodge
constexpr float kGap_m = 0.7f;

// Which of the avatar's other clips they run by; -1: none.
int RunOf(const Resident& resident, const Place& place) {
  for (size_t k = 0; k < resident.other_clips.size(); ++k) {
    if (resident.other_clips[k] == place.clip && resident.clip_mps[k] > 0) return static_cast<int>(k);
  }
  return -1;
}

bool MayPlay(const Resident& resident, const Place& place) {
  if (resident.leads || RunOf(resident, place) < 0) return false;
  const bool named = std::find(place.avatars.begin(), place.avatars.end(), resident.avatar) != place.avatars.end();
  return place.avatars.empty() ? resident.share > 0 : named;
}

// Free points of the place that one can run to straight from its middle, or near.
std::vector<Vec2> PointsOf(const Place& place, const Walkable& w) {
  std::vector<Vec2> points;
  for (int k = 0; k < kPoints; ++k) {
    const Vec2 way = DirectionOf(2 * kPi * (static_cast<float>(k) + 0.5f * static_cast<float>(k % 2)) / kPoints);
    for (float away_m = place.width_m / 2; away_m > 0.4f * place.width_m / 2; away_m -= 0.5f) {
      const Vec2 p = place.position_m + way * away_m;
      if (!IsFree(w, p) || !StraightWay(w, place.position_m, p)) continue;
      points.push_back(p);
      break;
    }
  }
  return points;
}

// Not so near that it would be no run; the present place where there is none.
Vec2 PickPoint(const PlayPlace& play, Vec2 from, Town* town) {
  Vec2 p = from;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    p = play.points[static_cast<size_t>(town->random.Below(static_cast<int>(play.points.size())))];
    if (Length(p - from) > kMinRun_m) break;
  }
  return p;
}

bool AnybodyAt(const Town& town, Vec2 p) {
  return std::any_of(town.crowd.position.begin(), town.crowd.position.end(),
                     [&](Vec2 other) { return Length(other - p) < kGap_m; });
}

int PickPlayer(const Place& place, Town* town) {
  std::vector<int> able;
  for (size_t k = 0; k < town->residents.size(); ++k) {
    if (MayPlay(town->residents[k], place)) able.push_back(static_cast<int>(k));
  }
  return able.empty() ? -1 : able[static_cast<size_t>(town->random.Below(static_cast<int>(able.size())))];
}

void Run(size_t i, Town* town) {
  Crowd& c = town->crowd;
  const PersonPlan& plan = PlanOf(i, town);
  const PlayPlace& play = town->play_places[static_cast<size_t>(plan.play)];
  SetGoal(i, FieldFor(PickPoint(play, c.position[i], town), &c), &c);
  const Place& place = town->places[static_cast<size_t>(play.place)];
  c.doing[i] = static_cast<int8_t>(RunOf(town->residents[static_cast<size_t>(c.avatar[i])], place));
}

void AddPlayer(int avatar, int which, Town* town) {
  const PlayPlace& play = town->play_places[static_cast<size_t>(which)];
  const Place& place = town->places[static_cast<size_t>(play.place)];
  const Resident& resident = town->residents[static_cast<size_t>(avatar)];
  Person p = NewPersonOf(avatar, town);
  p.preferred_mps = resident.clip_mps[static_cast<size_t>(RunOf(resident, place))] * town->random.Uniform(0.9f, 1.05f);
  p.top_mps = std::max(p.top_mps, kTop * p.preferred_mps);
  bool found = false;
  for (int attempt = 0; attempt < kTries && !found; ++attempt) {
    const Vec2 at = play.points[static_cast<size_t>(town->random.Below(static_cast<int>(play.points.size())))];
    p.position = place.position_m + (at - place.position_m) * town->random.Uniform(0.3f, 1.0f);
    found = IsFree(town->walkable, p.position) && !AnybodyAt(*town, p.position);
  }
  if (!found) return;
  PersonPlan plan{{}, true, false};
  plan.play = which;
  plan.play_s = town->random.Uniform(0, kMaxRest_s);
  AddToTown(p, std::move(plan), town);
}

void Play(size_t i, float passed_s, Town* town) {
  Crowd& c = town->crowd;
  float& left_s = PlanOf(i, town).play_s;
  left_s -= passed_s;
  if (c.field[i] < 0) {
    if (left_s <= 0) {
      Run(i, town);
      left_s = kHeldUp_s;
    }
    return;
  }
  if (c.arrived[i] != Arrival::kNot) {
    SetGoal(i, -1, &c);
    left_s = town->random.Uniform(kMinRest_s, kMaxRest_s);
  } else if (Length(c.velocity[i]) > kSlow_mps) {
    left_s = kHeldUp_s;
  } else if (left_s <= 0) {
    Run(i, town);
    left_s = kHeldUp_s;
  }
}

}  // namespace

int PlacePlayers(int wanted, Town* town) {
  const size_t before = town->crowd.size();
  town->play_places.clear();
  for (int k : town->place_lists.plays) {
    const Place& place = town->places[static_cast<size_t>(k)];
    PlayPlace play{k, PointsOf(place, town->walkable)};
    const bool anybody = std::any_of(town->residents.begin(), town->residents.end(),
                                     [&](const Resident& resident) { return MayPlay(resident, place); });
    if (!anybody || play.points.size() < 2) {
      town->warnings.push_back(
          "place '" + place.name + "': nobody can play there; " +
          (anybody ? "there is no room to run" : "no avatar has the clip '" + place.clip + "' with a speed_mps"));
      continue;
    }
    town->play_places.push_back(std::move(play));
    for (int n = 0; n < place.people && static_cast<int>(town->crowd.size() - before) < wanted; ++n)
      AddPlayer(PickPlayer(place, town), static_cast<int>(town->play_places.size()) - 1, town);
  }
  return static_cast<int>(town->crowd.size() - before);
}

void StepPlay(const Viewer& viewer, Town* town) {
  if (town->play_places.empty() || town->step % kLookEvery_steps != 0) return;
  const float passed_s = Step_s(viewer.settings) * kLookEvery_steps;
  for (size_t i = 0; i < town->crowd.size(); ++i) {
    if (PlanOf(i, town).play >= 0) Play(i, passed_s, town);
  }
}

float FastestPlay_mps(const Town& town) {
  float fastest_mps = 0;
  for (size_t i = 0; i < town.crowd.size(); ++i) {
    if (PlanOf(i, town).play >= 0) fastest_mps = std::max(fastest_mps, town.crowd.top_mps[i]);
  }
  return fastest_mps;
}

}  // namespace flaneur
