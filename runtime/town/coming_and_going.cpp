#include "runtime/town/coming_and_going.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/constants.h"
#include "runtime/crowd/fast_math.h"
#include "runtime/town/company.h"
#include "runtime/town/courtesy.h"
#include "runtime/town/loitering.h"
#include "runtime/town/places.h"
#include "runtime/town/play.h"
#include "runtime/town/population.h"
#include "runtime/town/ways_out.h"
#include "runtime/town/work.h"

namespace flaneur {
namespace {

constexpr float kBirthGap_m = 0.3f;    // between a newcomer and everybody else, beyond touching
constexpr int kTries = 40;             // to find a free spot before giving up for now
constexpr int kTriesFarAway = 20;      // of them at gates beyond r_unimportant only
constexpr int kThinkEvery_steps = 30;  // held up in a crowd of so many people a square metre,
constexpr float kThinksFrom_pm2 = 1.2f;
constexpr float kThinksAgain = 0.15f;  // this share decides to go somewhere else
constexpr int kBirths_perStep = 2;
constexpr int kGateSpots = 9;  // the gate itself, and a ring
constexpr float kBesideGate_m = 0.95f;

bool Crowded(const Crowd& crowd, Vec2 p, float radius_m) {
  for (size_t i = 0; i < crowd.size(); ++i) {
    const float reach_m = radius_m + crowd.radius_m[i] + kBirthGap_m;
    const Vec2 off = crowd.position[i] - p;
    if (Dot(off, off) < reach_m * reach_m) return true;
  }
  return false;
}

// Where a scenario's person goes next, with whoever is in their group. False where they have nowhere left to go.
bool NextGoal(const Company& company, Town* town) {
  Crowd& c = town->crowd;
  bool any = false;
  for (int k = 0; k < company.size; ++k) {
    std::vector<Vec2>& goals = PlanOf(company.member[k], town).goals;
    if (goals.empty()) continue;
    SetGoal(company.member[k], FieldFor(goals.front(), &c), &c);
    goals.erase(goals.begin());
    any = true;
  }
  return any;
}

// On the way to somewhere that they chose themselves and only pass.
bool Strolls(size_t i, const Town& town) {
  const PersonPlan& plan = PlanOf(i, town);
  return town.crowd.field[i] >= 0 && plan.goals.empty() && !plan.stay && !plan.leaves && !plan.loiters && plan.work < 0;
}

// Near is as good as there, but for a door, a place to stand at and what a scenario asks for.
bool HasArrived(size_t i, Town* town) {
  const Crowd& c = town->crowd;
  if (c.arrived[i] != Arrival::kNear) return c.arrived[i] == Arrival::kThere;
  if (!Strolls(i, *town)) return false;
  const int place = PlaceOfField(c.field[i], town);
  return place < 0 || !IsGate(town->places[static_cast<size_t>(place)]);
}

// True where the person is done and leaves the scene.
bool NextForArrived(size_t i, const Viewer& viewer, Town* town) {
  Crowd& c = town->crowd;
  const PersonPlan& plan = PlanOf(i, town);
  const Company company = CompanyOf(c, i);
  if (NextGoal(company, town)) return false;
  if (plan.stay) {
    SetGoal(i, -1, &c);
    return false;
  }
  if (plan.leaves) return true;
  if (plan.loiters || plan.work >= 0) return false;  // loitering.h, work.h
  const int place = PlaceOfField(c.field[i], town);
  if (place >= 0 && IsGate(town->places[static_cast<size_t>(place)])) return true;
  SendAll(company, PickDestination(viewer, c.position[i], true, town), town);
  return false;
}

// Whoever is held up in a crowd thinks again, now and then, about where to go.
bool ThinksAgain(size_t i, Town* town) {
  const Crowd& c = town->crowd;
  if ((town->step + c.id[i]) % kThinkEvery_steps != 0 || c.activity[i] != Activity::kWalking) return false;
  if (c.detour_s[i] > 0 || Length(c.velocity[i]) > kHeldUp * c.preferred_mps[i] || !Strolls(i, *town)) return false;
  return DensityAt_pm2(town->density, c.position[i]) > kThinksFrom_pm2 && town->random.Uniform() < kThinksAgain;
}

bool IsUnseen(const Viewer& viewer, Vec2 p, float reach_m) {
  return !viewer.present || Classify(p, reach_m, viewer.camera, viewer.outer_apex_back_m) == ViewClass::kOutside;
}

// Where somebody who comes through the gate can stand; x is NaN where there is no room.
Vec2 SpotAtGate(const Viewer& viewer, const Town& town, Vec2 gate, const Person& person) {
  const float reach_m = town.residents[static_cast<size_t>(person.avatar)].reach_m;
  for (int k = 0; k < kGateSpots; ++k) {
    const float angle = 2 * kPi * static_cast<float>(k) / (kGateSpots - 1);
    const Vec2 p = k == 0 ? gate : gate + DirectionOf(angle) * kBesideGate_m;
    if (IsUnseen(viewer, p, reach_m) && !Crowded(town.crowd, p, person.radius_m) &&
        (k == 0 || (IsFree(town.walkable, p) && StraightWay(town.walkable, gate, p))))
      return p;
  }
  return {std::nanf(""), 0};
}

// One person or a group, through a gate that is out of sight. False where there is no room for them now.
bool Birth(int company, const Viewer& viewer, Town* town) {
  const std::vector<int>& gates = town->place_lists.gates;
  if (gates.empty()) return false;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const Vec2 gate = town->places[static_cast<size_t>(
                                       gates[static_cast<size_t>(town->random.Below(static_cast<int>(gates.size())))])]
                          .position_m;
    if (!IsUnseen(viewer, gate, 0) || IsFullNear(viewer, *town, gate)) continue;
    const bool is_near = viewer.present && Length(gate - viewer.camera.position) < viewer.settings.r_unimportant_m;
    if (is_near && attempt < kTriesFarAway) continue;
    std::vector<int> members;
    int field = -1;
    for (int k = 0; k < company; ++k) {
      Person p = NewPerson(town);
      p.position = SpotAtGate(viewer, *town, gate, p);
      if (std::isnan(p.position.x)) break;
      if (k == 0) field = PickDestination(viewer, gate, true, town);
      p.field = field;
      members.push_back(static_cast<int>(town->crowd.size()));
      AddToTown(p, PersonPlan{{}, false, false}, town);
      Send(town->crowd.size() - 1, field, town);
    }
    if (members.size() > 1) AddGroup(members, &town->crowd);
    if (!members.empty()) return true;
  }
  return false;
}

bool HasWaited(const Town& town, size_t i) {
  const Crowd& c = town.crowd;
  return c.activity[i] != Activity::kWalking && c.wait_s[i] <= 0 && c.field[i] < 0 && !PlanOf(i, town).leaves &&
         PlanOf(i, town).work < 0 && PlanOf(i, town).play < 0;
}

}  // namespace

void LeaveAndArrive(const Viewer& viewer, Town* town) {
  Crowd& c = town->crowd;
  if (town->step % kThinkEvery_steps == 0) CountPeople(town->walkable, c.position, &town->density);
  SendEnclosedOut(viewer, town);
  StepOutlook(viewer, town);
  StepLoitering(viewer, town);
  StepWork(viewer, town);
  StepPlay(viewer, town);
  for (size_t i = 0; i < c.size();) {
    if (HasWaited(*town, i) && !StaysOn(i, viewer, town))
      SendAll(CompanyOf(c, i), PickDestination(viewer, c.position[i], false, town), town);
    if (ThinksAgain(i, town)) SendAll(CompanyOf(c, i), PickDestination(viewer, c.position[i], false, town), town);
    if (IsHeldUpByVisitor(i, viewer, town)) SendAll(CompanyOf(c, i), DestinationAway(i, viewer, town), town);
    if (HasArrived(i, town) && NextForArrived(i, viewer, town)) {
      StopLoitering(i, town);
      StopWork(i, town);
      RemovePerson(i, &c);
      continue;
    }
    ++i;
  }
  for (int k = 0; k < kBirths_perStep; ++k) {
    if (town->next_company == 0) town->next_company = std::min(town->target_people, DrawCompany(kMaxGroupSize, town));
    if (static_cast<int>(c.size()) + std::max(1, town->next_company) > town->target_people ||
        !Birth(town->next_company, viewer, town))
      return;
    town->next_company = 0;
  }
}

}  // namespace flaneur
