#include "runtime/player/population.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/player/company.h"
#include "runtime/player/loitering.h"
#include "runtime/player/painted.h"
#include "runtime/player/places.h"

namespace flaneur {
namespace {

// Sizes of groups seen in public places: Poisson's distribution without zero, here of mean 0.83 and from 2 on (James 1953, The
// distribution of free-forming small group size; Moussaid et al. 2010 for a shopping street).
constexpr float kShareOfTwo = 0.75f, kShareOfThree = 0.21f;
constexpr float kMeanGroup = 2 * kShareOfTwo + 3 * kShareOfThree + 4 * (1 - kShareOfTwo - kShareOfThree);
constexpr float kSpawnReach_m = 8;     // who starts at a place of that kind starts so near it, where there is room
constexpr float kGroupReach_m = 2.5f;  // members start so near each other
constexpr float kLoiterGap_m = 0.7f;   // between the middles of people who stand about at the start, and everybody else
constexpr float kWideGap_m = 0.5f, kLeastGap_m = 0.1f;  // between people at the start, beyond touching

int PickAvatar(Simulation* s) {
  float total = 0;
  for (float share : s->avatar_share) total += share;
  float left = s->random.Uniform() * total;
  for (size_t i = 0; i < s->avatar_share.size(); ++i) {
    left -= s->avatar_share[i];
    if (left < 0 && s->avatar_share[i] > 0) return static_cast<int>(i);
  }
  return 0;
}

// Which cells of the navigation grid are still to be had: looked up, so that starting is linear in people.
struct Spots {
  std::vector<int> cells;     // where people may live, in random order
  std::vector<int> occupant;  // by cell of the grid: index in the crowd, -1: nobody
  size_t next = 0;
  float gap_m = kWideGap_m;   // beyond touching, to everybody else
};

void Occupy(const Walkable& w, const Crowd& c, size_t i, Spots* spots) {
  const int cell = CellAt(w, c.position[i]);
  if (cell >= 0) spots->occupant[static_cast<size_t>(cell)] = static_cast<int>(i);
}

bool IsNearSpawn(const Simulation& s, Vec2 p) {
  return std::any_of(s.place_lists.spawns.begin(), s.place_lists.spawns.end(), [&](int spawn) {
    return Length(s.places[static_cast<size_t>(spawn)].position_m - p) < kSpawnReach_m;
  });
}

Spots MakeSpots(Simulation* s) {
  Spots spots{PaintedOrder(s->painting.people, HomeCells(*s), s), std::vector<int>(s->walkable.cost.size(), -1)};
  if (!s->place_lists.spawns.empty()) {
    std::stable_partition(spots.cells.begin(), spots.cells.end(), [&](int cell) { return IsNearSpawn(*s, CellCenter(s->walkable, cell)); });
  }
  for (size_t i = 0; i < s->crowd.size(); ++i) Occupy(s->walkable, s->crowd, i, &spots);
  return spots;
}

bool IsToBeHad(const Simulation& s, const Spots& spots, int cell, float radius_m) {
  const Walkable& w = s.walkable;
  const Vec2 p = CellCenter(w, cell);
  const float most_radius_m = *std::max_element(s.avatar_radius_m.begin(), s.avatar_radius_m.end());
  const int reach = static_cast<int>(std::ceil((radius_m + most_radius_m + spots.gap_m) / w.cell_m + 0.5f));
  const int column = cell % w.columns, row = cell / w.columns;
  for (int y = std::max(0, row - reach); y <= std::min(w.rows - 1, row + reach); ++y) {
    for (int x = std::max(0, column - reach); x <= std::min(w.columns - 1, column + reach); ++x) {
      const int other = spots.occupant[static_cast<size_t>(y * w.columns + x)];
      if (other < 0) continue;
      const size_t j = static_cast<size_t>(other);
      if (Length(s.crowd.position[j] - p) < radius_m + s.crowd.radius_m[j] + spots.gap_m) return false;
    }
  }
  return !s.camera.present || Length(p - s.camera.view.position) > s.r_personal_m + radius_m + 0.5f;
}

// The next cell for somebody who comes alone or first, -1 when there is none left. Who finds the town full squeezes in.
int NextSpot(const Simulation& s, float radius_m, Spots* spots) {
  for (;;) {
    while (spots->next < spots->cells.size() && !IsToBeHad(s, *spots, spots->cells[spots->next], radius_m)) ++spots->next;
    if (spots->next < spots->cells.size()) return spots->cells[spots->next];
    if (spots->gap_m <= kLeastGap_m) return -1;
    spots->gap_m = kLeastGap_m;
    spots->next = 0;
  }
}

// The nearest cell to walk up to the companion from, -1 when there is none.
int SpotBeside(const Simulation& s, Vec2 companion, float radius_m, const Spots& spots) {
  const Walkable& w = s.walkable;
  const int home = CellAt(w, companion), reach = static_cast<int>(kGroupReach_m / w.cell_m);
  int best = -1;
  float best_m = kGroupReach_m;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const Vec2 p = CellCenter(w, home) + Vec2{static_cast<float>(x), static_cast<float>(y)} * w.cell_m;
      const float away_m = Length(p - companion);
      if (away_m >= best_m || !IsFree(w, p) || !StraightWay(w, companion, p)) continue;
      if (s.crowd_area && !Contains(*s.crowd_area, p)) continue;
      if (IsToBeHad(s, spots, CellAt(w, p), radius_m)) best = CellAt(w, p), best_m = away_m;
    }
  }
  return best;
}

void LookAlong(Person* p, const Simulation& s) {
  if (p->field < 0) return;
  const Vec2 way = s.crowd.fields[static_cast<size_t>(p->field)].goal - p->position;
  p->heading_rad = std::atan2(way.y, way.x);
}

// Company that stands at a loiter place as if it had come a while ago. False where that is not to be.
bool PlaceLoiterers(int company, Simulation* s) {
  const std::vector<int>& places = s->place_lists.loiters;
  if (places.empty()) return false;
  const int place = places[static_cast<size_t>(s->random.Below(static_cast<int>(places.size())))];
  int spots[kMostInGroup];
  if (!FindSpots(*s, place, s->places[static_cast<size_t>(place)].position_m, company, spots)) return false;
  for (int k = 0; k < company; ++k) {
    const Vec2 p = s->loiter_spots[static_cast<size_t>(spots[k])].position_m;
    const auto stands_there = [&](Vec2 other) { return Length(other - p) < kLoiterGap_m; };
    if (std::any_of(s->crowd.position.begin(), s->crowd.position.end(), stands_there)) return false;
    if (s->camera.present && Length(p - s->camera.view.position) < s->r_personal_m + kLoiterGap_m) return false;
  }
  std::vector<int> members;
  for (int k = 0; k < company; ++k) {
    const LoiterSpot& spot = s->loiter_spots[static_cast<size_t>(spots[k])];
    Person p = NewPerson(s);
    p.position = spot.position_m;
    p.heading_rad = std::atan2(spot.look.y, spot.look.x);
    members.push_back(static_cast<int>(s->crowd.size()));
    AddToTown(p, PersonPlan{{}, false, false}, s);
    TakeSpot(s->crowd.size() - 1, spots[k], true, s);
  }
  if (members.size() > 1) AddGroup(members, &s->crowd);
  return true;
}

// Up to `company` people who belong together; how many found room.
int PlaceCompany(int company, Spots* spots, Simulation* s) {
  std::vector<int> members;
  int field = -1;
  for (int k = 0; k < company; ++k) {
    Person p = NewPerson(s);
    const int cell = k == 0 ? NextSpot(*s, p.radius_m, spots)
                            : SpotBeside(*s, s->crowd.position[static_cast<size_t>(members[0])], p.radius_m, *spots);
    if (cell < 0) break;
    p.position = CellCenter(s->walkable, cell);
    if (k == 0) field = PickDestination(p.position, true, s);
    p.field = field;
    LookAlong(&p, *s);
    members.push_back(static_cast<int>(s->crowd.size()));
    AddToTown(p, PersonPlan{{}, false, false}, s);
    Send(s->crowd.size() - 1, field, s);
    Occupy(s->walkable, s->crowd, s->crowd.size() - 1, spots);
  }
  if (members.size() > 1) AddGroup(members, &s->crowd);
  return static_cast<int>(members.size());
}

Error TakeScenarioPerson(const ScenarioPerson& wanted, const std::string& name, Simulation* s) {
  Person p;
  if (!wanted.avatar.empty()) {
    const auto found = std::find(s->avatar_names.begin(), s->avatar_names.end(), wanted.avatar);
    if (found != s->avatar_names.end()) p.avatar = static_cast<int>(found - s->avatar_names.begin());
    else if (s->avatar_names != std::vector<std::string>{kPlainFigure}) return Fail(name + ": there is no avatar '" + wanted.avatar + "'");
  }
  p.radius_m = wanted.radius_m > 0 ? wanted.radius_m : s->avatar_radius_m[static_cast<size_t>(p.avatar)];
  p.preferred_mps = wanted.speed_mps > 0 ? wanted.speed_mps : s->crowd_settings.preferred_speed_mps;
  p.top_mps = wanted.top_speed_mps > 0 ? wanted.top_speed_mps : std::max(s->crowd_settings.top_speed_mps, p.preferred_mps);
  if (p.top_mps < p.preferred_mps) return Fail(name + ": contradictory limits: speed_mps is above top_speed_mps");
  p.position = wanted.position_m;
  if (InsideObstacle(s->walkable, p.position)) return Fail(name + ": starts inside an obstacle");
  if (CellAt(s->walkable, p.position) < 0) return Fail(name + ": starts outside the ground");
  PersonPlan plan{wanted.goals_m, wanted.stay, true};
  for (size_t g = 0; g < wanted.goals_m.size(); ++g) {
    const int field = FieldFor(wanted.goals_m[g], &s->crowd);
    if (!Reachable(s->walkable, s->crowd.fields[static_cast<size_t>(field)], p.position)) {
      return Fail(name + ": nobody can get to goal " + std::to_string(g + 1));
    }
  }
  if (!plan.goals.empty()) {
    p.field = FieldFor(plan.goals.front(), &s->crowd);
    plan.goals.erase(plan.goals.begin());
    LookAlong(&p, *s);
  }
  AddToTown(p, std::move(plan), s);
  return Ok();
}

bool SameGoals(const ScenarioPerson& a, const ScenarioPerson& b) {
  return std::equal(a.goals_m.begin(), a.goals_m.end(), b.goals_m.begin(), b.goals_m.end(),
                    [](Vec2 p, Vec2 q) { return p.x == q.x && p.y == q.y; });
}

// Those who name the same group; `first` is the index in the crowd of the first person.
Error JoinScenarioPeople(const std::vector<ScenarioPerson>& persons, size_t first, Simulation* s) {
  std::vector<char> done(persons.size(), 0);
  for (size_t k = 0; k < persons.size(); ++k) {
    if (persons[k].group.empty() || done[k]) continue;
    const std::string name = "group '" + persons[k].group + "'";
    std::vector<int> members;
    for (size_t j = k; j < persons.size(); ++j) {
      if (persons[j].group != persons[k].group) continue;
      if (!SameGoals(persons[j], persons[k])) {
        return Fail(name + ": person " + std::to_string(k + 1) + " and person " + std::to_string(j + 1) + " have different goals_m");
      }
      members.push_back(static_cast<int>(first + j));
      done[j] = 1;
    }
    if (members.size() < 2 || members.size() > kMostInGroup) {
      return Fail(name + " has " + std::to_string(members.size()) + " people; 2 to 4 can walk together");
    }
    AddGroup(members, &s->crowd);
  }
  return Ok();
}

}  // namespace

Person NewPerson(Simulation* s) {
  const CrowdSettings& c = s->crowd_settings;
  Person p;
  p.avatar = PickAvatar(s);
  p.radius_m = s->avatar_radius_m[static_cast<size_t>(p.avatar)];
  // The sum of three even draws is near a normal one, and bounded.
  const float spread = (s->random.Uniform(-1, 1) + s->random.Uniform(-1, 1) + s->random.Uniform(-1, 1)) * c.speed_spread_mps;
  p.top_mps = c.top_speed_mps;
  p.preferred_mps = std::clamp(c.preferred_speed_mps + spread, 0.5f * c.preferred_speed_mps, c.top_speed_mps);
  p.heading_rad = s->random.Uniform(-kPi, kPi);
  return p;
}

int DrawCompany(int most, Simulation* s) {
  const float share = s->crowd_settings.group_share;
  if (share <= 0) return 1;
  // So many of the arrivals are groups that `share` of the people are in one.
  if (s->random.Uniform() >= share / (kMeanGroup - share * (kMeanGroup - 1))) return 1;
  const float draw = s->random.Uniform();
  const int size = draw < kShareOfTwo ? 2 : draw < kShareOfTwo + kShareOfThree ? 3 : 4;
  return std::min(size, most);
}

void AddToTown(const Person& person, PersonPlan plan, Simulation* s) {
  AddPerson(person, &s->crowd);
  s->crowd.view.back() = ViewClass::kOutside;
  s->plans.push_back(std::move(plan));
}

Error PlaceScenarioPeople(const Scenario& scenario, Simulation* s) {
  const size_t first = s->crowd.size();
  for (size_t k = 0; k < scenario.persons.size(); ++k) {
    if (Error e = TakeScenarioPerson(scenario.persons[k], "person " + std::to_string(k + 1), s)) return e;
  }
  return JoinScenarioPeople(scenario.persons, first, s);
}

void PlaceCrowd(Simulation* s) {
  const int wanted = s->crowd_settings.people - (s->guide.id >= 0 ? 1 : 0);  // the guide is one of them
  s->target_people = static_cast<int>(s->crowd.size()) + wanted;
  if (wanted == 0) return;
  PreparePlaces(s);
  PrepareLoitering(s);
  int placed = 0;
  const int standing = static_cast<int>(s->crowd_settings.loiter_share * static_cast<float>(wanted));
  for (int tries = 0; tries < 2 * standing && placed < standing; ++tries) {
    const int company = DrawCompany(standing - placed, s);
    if (PlaceLoiterers(company, s)) placed += company;
  }
  Spots spots = MakeSpots(s);
  while (placed < wanted) {
    const int company = PlaceCompany(DrawCompany(wanted - placed, s), &spots, s);
    placed += company;
    if (company > 0) continue;
    s->warnings.push_back("only " + std::to_string(placed) + " of " + std::to_string(wanted) + " people fit on the walkable ground");
    s->target_people = static_cast<int>(s->crowd.size());
    return;
  }
}

}  // namespace flaneur
