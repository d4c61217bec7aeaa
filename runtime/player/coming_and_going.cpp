#include "runtime/player/coming_and_going.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/fast_math.h"
#include "runtime/player/places.h"
#include "runtime/player/population.h"
#include "runtime/player/ways_out.h"

namespace flaneur {
namespace {

constexpr float kLeastWait_s = 15, kMostWait_s = 50;
constexpr float kBirthGap_m = 0.3f;         // between a newcomer and everybody else, beyond touching
constexpr int kTries = 40;                  // to find a free spot before giving up for now
constexpr int kTriesFarAway = 20;           // of them at gates beyond r_unimportant only
constexpr int kBirths_perStep = 2;
constexpr float kTalkingDistance_m = 2.5f;
constexpr int kGateSpots = 9;               // the gate itself, and a ring
constexpr float kBesideGate_m = 0.95f;

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

bool IsUnseen(const Simulation& s, Vec2 p) {
  return !s.camera.present || Classify(p, s.camera.view, s.outer_apex_back_m) == ViewClass::kOutside;
}

// Where somebody who comes through the gate can stand; x is NaN where there is no room.
Vec2 SpotAtGate(const Simulation& s, Vec2 gate, float radius_m) {
  for (int k = 0; k < kGateSpots; ++k) {
    const float angle = 2 * kPi * static_cast<float>(k) / (kGateSpots - 1);
    const Vec2 p = k == 0 ? gate : gate + DirectionOf(angle) * kBesideGate_m;
    if (IsUnseen(s, p) && !Crowded(s.crowd, p, radius_m) && (k == 0 || (IsFree(s.walkable, p) && StraightWay(s.walkable, gate, p)))) return p;
  }
  return {std::nanf(""), 0};
}

// One person or a group, through a gate that is out of sight. False where there is no room for them now.
bool Birth(int company, Simulation* s) {
  const std::vector<int>& gates = s->place_lists.gates;
  if (gates.empty()) return false;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const Vec2 gate = s->places[static_cast<size_t>(gates[static_cast<size_t>(s->random.Below(static_cast<int>(gates.size())))])].position_m;
    if (!IsUnseen(*s, gate) || IsFullNear(*s, gate)) continue;
    const bool is_near = s->camera.present && Length(gate - s->camera.view.position) < s->influence.r_unimportant_m;
    if (is_near && attempt < kTriesFarAway) continue;
    std::vector<int> members;
    int field = -1;
    for (int k = 0; k < company; ++k) {
      Person p = NewPerson(s);
      p.position = SpotAtGate(*s, gate, p.radius_m);
      if (std::isnan(p.position.x)) break;
      if (k == 0) field = PickDestination(gate, true, s);
      p.field = field;
      members.push_back(static_cast<int>(s->crowd.size()));
      AddToTown(p, PersonPlan{{}, false, false}, s);
    }
    if (members.size() > 1) AddGroup(members, &s->crowd);
    if (!members.empty()) return true;
  }
  return false;
}

bool HasWaited(const Simulation& s, size_t i) {
  const Crowd& c = s.crowd;
  return c.activity[i] != Activity::kWalking && c.wait_s[i] <= 0 && c.field[i] < 0 && !s.plans[static_cast<size_t>(c.id[i])].leaves;
}

}  // namespace

void LeaveAndArrive(Simulation* s) {
  Crowd& c = s->crowd;
  SendEnclosedOut(s);
  for (size_t i = 0; i < c.size();) {
    if (HasWaited(*s, i)) SendAll(CompanyOf(c, i), PickDestination(c.position[i], false, s), &c);
    if (c.arrived[i] && NextForArrived(i, s)) {
      RemovePerson(i, &c);
      continue;
    }
    ++i;
  }
  for (int k = 0; k < kBirths_perStep; ++k) {
    if (s->next_company == 0) s->next_company = std::min(s->target_people, DrawCompany(kMostInGroup, s));
    if (static_cast<int>(c.size()) + std::max(1, s->next_company) > s->target_people || !Birth(s->next_company, s)) return;
    s->next_company = 0;
  }
}

}  // namespace flaneur
