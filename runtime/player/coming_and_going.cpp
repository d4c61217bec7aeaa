#include "runtime/player/coming_and_going.h"

#include <algorithm>
#include <cmath>

#include "runtime/player/places.h"
#include "runtime/player/population.h"

namespace flaneur {
namespace {

constexpr float kLeastWait_s = 15, kMostWait_s = 50;
constexpr float kBirthGap_m = 0.3f;         // between a newcomer and everybody else, beyond touching
constexpr int kTries = 40;                  // to find a free spot before giving up for now
constexpr int kBirths_perStep = 2;
constexpr float kTalkingDistance_m = 2.5f;

// The people who do what person i does: the group, or i alone.
struct Company {
  int size = 1;
  size_t member[kMostInGroup];
};

Company CompanyOf(const Crowd& c, size_t i) {
  Company all;
  all.member[0] = i;
  if (c.group[i] < 0) return all;
  const Group& g = c.groups[static_cast<size_t>(c.group[i])];
  all.size = g.size;
  for (int k = 0; k < g.size; ++k) all.member[k] = static_cast<size_t>(g.member[k]);
  return all;
}

void SendAll(const Company& company, int field, Crowd* c) {
  for (int k = 0; k < company.size; ++k) SetGoal(company.member[k], field, c);
}

bool Crowded(const Crowd& crowd, Vec2 p, float radius_m) {
  for (size_t i = 0; i < crowd.size(); ++i) {
    const float reach_m = radius_m + crowd.radius_m[i] + kBirthGap_m;
    const Vec2 off = crowd.position[i] - p;
    if (Dot(off, off) < reach_m * reach_m) return true;
  }
  return false;
}

// Who stands talks with the nearest one who stands there too, and faces them.
void Loiter(size_t i, Simulation* s) {
  Crowd& c = s->crowd;
  SetGoal(i, -1, &c);
  c.wait_s[i] = s->random.Uniform(kLeastWait_s, kMostWait_s);
  float nearest_m = kTalkingDistance_m;
  for (size_t j = 0; j < c.size(); ++j) {
    const Vec2 way = c.position[j] - c.position[i];
    if (j == i || c.field[j] >= 0 || Length(way) >= nearest_m || Length(way) < 1e-3f) continue;
    nearest_m = Length(way);
    c.facing[i] = way * (1 / nearest_m);
    c.facing[j] = c.facing[i] * -1;
    c.activity[i] = c.activity[j] = Activity::kTalking;
  }
}

// Where a scenario's person goes next, with whoever is in their group. False where they have nowhere left to go.
bool NextGoal(const Company& company, Simulation* s) {
  Crowd& c = s->crowd;
  bool any = false;
  for (int k = 0; k < company.size; ++k) {
    std::vector<Vec2>& goals = s->plans[static_cast<size_t>(c.id[company.member[k]])].goals;
    if (goals.empty()) continue;
    SetGoal(company.member[k], FieldFor(goals.front(), &c), &c);
    goals.erase(goals.begin());
    any = true;
  }
  return any;
}

// True where the person is done and leaves the scene.
bool NextForArrived(size_t i, Simulation* s) {
  Crowd& c = s->crowd;
  const PersonPlan& plan = s->plans[static_cast<size_t>(c.id[i])];
  const Company company = CompanyOf(c, i);
  if (NextGoal(company, s)) return false;
  if (plan.stay) {
    SetGoal(i, -1, &c);
    return false;
  }
  if (plan.leaves) return true;
  const PackPlace* place = PlaceAt(*s, c.fields[static_cast<size_t>(c.field[i])].goal);
  if (place != nullptr && IsGate(*place)) return true;
  if (place != nullptr && place->kind == "loiter") {
    Loiter(i, s);
    return false;
  }
  SendAll(company, PickDestination(c.position[i], true, s), &c);
  return false;
}

void Birth(Simulation* s) {
  const std::vector<int>& gates = s->place_lists.gates;
  if (gates.empty()) return;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const PackPlace& gate = s->places[static_cast<size_t>(gates[static_cast<size_t>(s->random.Below(static_cast<int>(gates.size())))])];
    const bool seen = s->camera.present &&
                      Classify(gate.position_m, s->camera.view, s->outer_apex_back_m) != ViewClass::kOutside;
    if (seen) continue;
    Person p = NewPerson(s);
    if (Crowded(s->crowd, gate.position_m, p.radius_m)) continue;
    p.position = gate.position_m;
    p.field = PickDestination(p.position, true, s);
    AddToTown(p, PersonPlan{{}, false, false}, s);
    return;
  }
}

bool HasWaited(const Simulation& s, size_t i) {
  const Crowd& c = s.crowd;
  return c.activity[i] != Activity::kWalking && c.wait_s[i] <= 0 && c.field[i] < 0 && !s.plans[static_cast<size_t>(c.id[i])].leaves;
}

}  // namespace

void LeaveAndArrive(Simulation* s) {
  Crowd& c = s->crowd;
  for (size_t i = 0; i < c.size();) {
    if (HasWaited(*s, i)) SendAll(CompanyOf(c, i), PickDestination(c.position[i], false, s), &c);
    if (c.arrived[i] && NextForArrived(i, s)) {
      RemovePerson(i, &c);
      continue;
    }
    ++i;
  }
  for (int k = 0; k < kBirths_perStep && static_cast<int>(c.size()) < s->target_people; ++k) Birth(s);
}

}  // namespace flaneur
