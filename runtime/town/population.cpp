#include "runtime/town/population.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/town/company.h"
#include "runtime/town/loitering.h"
#include "runtime/town/outlook.h"
#include "runtime/town/painted.h"
#include "runtime/town/places.h"
#include "runtime/town/play.h"
#include "runtime/town/work.h"

namespace flaneur {
namespace {

// Sizes of groups seen in public places: Poisson's distribution without zero, here of mean 0.83 and from 2 on (James
// 1953, The distribution of free-forming small group size; Moussaid et al. 2010 for a shopping street).
constexpr float kShareOfTwo = 0.75f, kShareOfThree = 0.21f;
constexpr float kMeanGroup = 2 * kShareOfTwo + 3 * kShareOfThree + 4 * (1 - kShareOfTwo - kShareOfThree);
constexpr float kSpawnReach_m = 8;     // who starts at a place of that kind starts so near it, where there is room
constexpr float kGroupReach_m = 2.5f;  // members start so near each other
constexpr float kLoiterGap_m = 0.7f;   // between the middles of people who stand about at the start, and everybody else
constexpr float kWideGap_m = 0.5f, kMinGap_m = 0.1f;  // between people at the start, beyond touching

int PickAvatar(Town* town) {
  float total = 0;
  for (const Resident& resident : town->residents) total += resident.share;
  float left = town->random.Uniform() * total;
  for (size_t i = 0; i < town->residents.size(); ++i) {
    left -= town->residents[i].share;
    if (left < 0 && town->residents[i].share > 0) return static_cast<int>(i);
  }
  return 0;
}

// What places to start at leave room in: every view that there may be, or only the first.
enum class Heeds { kEveryView, kFirstPicture, kNothing };

// Which cells of the navigation grid are still to be had: looked up, so that starting is linear in people.
struct Spots {
  std::vector<int> cells;     // where people may live, in random order
  std::vector<int> occupant;  // by cell of the grid: index in the crowd, -1: nobody
  size_t next = 0;
  float gap_m = kWideGap_m;  // beyond touching, to everybody else
  Heeds heeds = Heeds::kEveryView;
};

void Occupy(const Walkable& w, const Crowd& c, size_t i, Spots* spots) {
  const int cell = CellAt(w, c.position[i]);
  if (cell >= 0) spots->occupant[static_cast<size_t>(cell)] = static_cast<int>(i);
}

bool IsNearSpawn(const Town& town, Vec2 p) {
  return std::any_of(town.place_lists.spawns.begin(), town.place_lists.spawns.end(), [&](int spawn) {
    return Length(town.places[static_cast<size_t>(spawn)].position_m - p) < kSpawnReach_m;
  });
}

Spots MakeSpots(Town* town) {
  Spots spots{PaintedOrder(town->painting.people, HomeCells(*town), town),
              std::vector<int>(town->walkable.cost.size(), -1)};
  if (!town->place_lists.spawns.empty()) {
    std::stable_partition(spots.cells.begin(), spots.cells.end(),
                          [&](int cell) { return IsNearSpawn(*town, CellCenter(town->walkable, cell)); });
  }
  for (size_t i = 0; i < town->crowd.size(); ++i) Occupy(town->walkable, town->crowd, i, &spots);
  return spots;
}

bool IsToBeHad(const Viewer& viewer, const Town& town, const Spots& spots, int cell, float radius_m) {
  const Walkable& w = town.walkable;
  const Vec2 p = CellCenter(w, cell);
  float most_radius_m = 0;
  for (const Resident& resident : town.residents) most_radius_m = std::max(most_radius_m, resident.radius_m);
  const int reach = static_cast<int>(std::ceil((radius_m + most_radius_m + spots.gap_m) / w.cell_m + 0.5f));
  const int column = cell % w.columns, row = cell / w.columns;
  for (int y = std::max(0, row - reach); y <= std::min(w.rows - 1, row + reach); ++y) {
    for (int x = std::max(0, column - reach); x <= std::min(w.columns - 1, column + reach); ++x) {
      const int other = spots.occupant[static_cast<size_t>(y * w.columns + x)];
      if (other < 0) continue;
      const size_t j = static_cast<size_t>(other);
      if (Length(town.crowd.position[j] - p) < radius_m + town.crowd.radius_m[j] + spots.gap_m) return false;
    }
  }
  if (spots.heeds == Heeds::kEveryView && !HasRoomAtStart(viewer, town, p)) return false;
  if (spots.heeds == Heeds::kFirstPicture && ShowsTooManyAtStart(viewer, town, p)) return false;
  return !viewer.present || Length(p - viewer.camera.position) > viewer.settings.r_personal_m + radius_m + 0.5f;
}

// The next cell for somebody who comes alone or first, -1 when there is none left. Who finds the town full squeezes in.
int NextSpot(const Viewer& viewer, const Town& town, float radius_m, Spots* spots) {
  for (;;) {
    while (spots->next < spots->cells.size() && !IsToBeHad(viewer, town, *spots, spots->cells[spots->next], radius_m))
      ++spots->next;
    if (spots->next < spots->cells.size()) return spots->cells[spots->next];
    if (spots->gap_m > kMinGap_m) spots->gap_m = kMinGap_m;
    else if (spots->heeds == Heeds::kEveryView) spots->heeds = Heeds::kFirstPicture;
    else if (spots->heeds == Heeds::kFirstPicture) spots->heeds = Heeds::kNothing;
    else return -1;
    spots->next = 0;
  }
}

// The nearest cell to walk up to the companion from, -1 when there is none.
int SpotBeside(const Viewer& viewer, const Town& town, Vec2 companion, float radius_m, const Spots& spots) {
  const Walkable& w = town.walkable;
  const int home = CellAt(w, companion), reach = static_cast<int>(kGroupReach_m / w.cell_m);
  int best = -1;
  float best_m = kGroupReach_m;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const Vec2 p = CellCenter(w, home) + Vec2{static_cast<float>(x), static_cast<float>(y)} * w.cell_m;
      const float away_m = Length(p - companion);
      if (away_m >= best_m || !IsFree(w, p) || !StraightWay(w, companion, p)) continue;
      if (town.crowd_area && !Contains(*town.crowd_area, p)) continue;
      if (IsToBeHad(viewer, town, spots, CellAt(w, p), radius_m)) best = CellAt(w, p), best_m = away_m;
    }
  }
  return best;
}

void LookAlong(Person* p, const Town& town) {
  if (p->field < 0) return;
  const Vec2 way = town.crowd.fields[static_cast<size_t>(p->field)].goal - p->position;
  p->heading_rad = std::atan2(way.y, way.x);
}

// Company that stands at a loiter place as if it had come a while ago. False where that is not to be.
bool PlaceLoiterers(int company, const Viewer& viewer, Town* town) {
  const std::vector<int>& places = town->place_lists.loiters;
  if (places.empty()) return false;
  const int place = places[static_cast<size_t>(town->random.Below(static_cast<int>(places.size())))];
  int spots[kMaxGroupSize];
  if (!FindSpots(viewer, *town, place, town->places[static_cast<size_t>(place)].position_m, company, spots))
    return false;
  for (int k = 0; k < company; ++k) {
    const Vec2 p = town->loiter_spots[static_cast<size_t>(spots[k])].position_m;
    const auto stands_there = [&](Vec2 other) { return Length(other - p) < kLoiterGap_m; };
    if (std::any_of(town->crowd.position.begin(), town->crowd.position.end(), stands_there)) return false;
    if (viewer.present && Length(p - viewer.camera.position) < viewer.settings.r_personal_m + kLoiterGap_m)
      return false;
    if (!HasRoomAtStart(viewer, *town, p)) return false;
  }
  std::vector<int> members;
  for (int k = 0; k < company; ++k) {
    const LoiterSpot& spot = town->loiter_spots[static_cast<size_t>(spots[k])];
    Person p = NewPerson(town);
    p.position = spot.position_m;
    p.heading_rad = std::atan2(spot.look.y, spot.look.x);
    members.push_back(static_cast<int>(town->crowd.size()));
    AddToTown(p, PersonPlan{{}, false, false}, town);
    TakeSpot(town->crowd.size() - 1, spots[k], true, town);
  }
  if (members.size() > 1) AddGroup(members, &town->crowd);
  return true;
}

// Up to `company` people who belong together; how many found room.
int PlaceCompany(int company, const Viewer& viewer, Spots* spots, Town* town) {
  std::vector<int> members;
  int field = -1;
  for (int k = 0; k < company; ++k) {
    Person p = NewPerson(town);
    const int cell =
        k == 0 ? NextSpot(viewer, *town, p.radius_m, spots)
               : SpotBeside(viewer, *town, town->crowd.position[static_cast<size_t>(members[0])], p.radius_m, *spots);
    if (cell < 0) break;
    p.position = CellCenter(town->walkable, cell);
    if (k == 0) field = PickDestination(viewer, p.position, true, town);
    p.field = field;
    LookAlong(&p, *town);
    members.push_back(static_cast<int>(town->crowd.size()));
    AddToTown(p, PersonPlan{{}, false, false}, town);
    Send(town->crowd.size() - 1, field, town);
    Occupy(town->walkable, town->crowd, town->crowd.size() - 1, spots);
  }
  if (members.size() > 1) AddGroup(members, &town->crowd);
  return static_cast<int>(members.size());
}

Error TakeScenarioPerson(const ScenarioPerson& wanted, const std::string& name, Town* town) {
  Person p;
  if (!wanted.avatar.empty()) {
    const auto is_wanted = [&](const Resident& resident) { return resident.avatar == wanted.avatar; };
    const auto found = std::find_if(town->residents.begin(), town->residents.end(), is_wanted);
    if (found != town->residents.end()) p.avatar = static_cast<int>(found - town->residents.begin());
    else if (town->residents.size() != 1 || town->residents.front().avatar != kPlainFigure)
      return Fail(name + ": there is no avatar '" + wanted.avatar + "'");
  }
  p.radius_m = wanted.radius_m > 0 ? wanted.radius_m : town->residents[static_cast<size_t>(p.avatar)].radius_m;
  p.preferred_mps = wanted.speed_mps > 0 ? wanted.speed_mps : town->settings.preferred_speed_mps;
  p.top_mps = wanted.top_speed_mps > 0 ? wanted.top_speed_mps : std::max(town->settings.top_speed_mps, p.preferred_mps);
  if (p.top_mps < p.preferred_mps) return Fail(name + ": contradictory limits: speed_mps is above top_speed_mps");
  p.position = wanted.position_m;
  if (InsideObstacle(town->walkable, p.position)) return Fail(name + ": starts inside an obstacle");
  if (CellAt(town->walkable, p.position) < 0) return Fail(name + ": starts outside the ground");
  PersonPlan plan{wanted.goals_m, wanted.stay, true};
  for (size_t g = 0; g < wanted.goals_m.size(); ++g) {
    const int field = FieldFor(wanted.goals_m[g], &town->crowd);
    if (!Reachable(town->walkable, town->crowd.fields[static_cast<size_t>(field)], p.position)) {
      return Fail(name + ": nobody can get to goal " + std::to_string(g + 1));
    }
  }
  if (!plan.goals.empty()) {
    p.field = FieldFor(plan.goals.front(), &town->crowd);
    plan.goals.erase(plan.goals.begin());
    LookAlong(&p, *town);
  }
  AddToTown(p, std::move(plan), town);
  return Ok();
}

bool SameGoals(const ScenarioPerson& a, const ScenarioPerson& b) {
  return std::equal(a.goals_m.begin(), a.goals_m.end(), b.goals_m.begin(), b.goals_m.end(),
                    [](Vec2 p, Vec2 q) { return p.x == q.x && p.y == q.y; });
}

// Those who name the same group; `first` is the index in the crowd of the first person.
Error JoinScenarioPeople(const std::vector<ScenarioPerson>& persons, size_t first, Town* town) {
  std::vector<char> done(persons.size(), 0);
  for (size_t k = 0; k < persons.size(); ++k) {
    if (persons[k].group.empty() || done[k]) continue;
    const std::string name = "group '" + persons[k].group + "'";
    std::vector<int> members;
    for (size_t j = k; j < persons.size(); ++j) {
      if (persons[j].group != persons[k].group) continue;
      if (!SameGoals(persons[j], persons[k])) {
        return Fail(name + ": person " + std::to_string(k + 1) + " and person " + std::to_string(j + 1) +
                    " have different goals_m");
      }
      members.push_back(static_cast<int>(first + j));
      done[j] = 1;
    }
    if (members.size() < 2 || members.size() > kMaxGroupSize) {
      return Fail(name + " has " + std::to_string(members.size()) + " people; 2 to 4 can walk together");
    }
    AddGroup(members, &town->crowd);
  }
  return Ok();
}

}  // namespace

Person NewPerson(Town* town) { return NewPersonOf(PickAvatar(town), town); }

Person NewPersonOf(int avatar, Town* town) {
  const CrowdSettings& c = town->settings;
  Person p;
  p.avatar = avatar;
  p.radius_m = town->residents[static_cast<size_t>(p.avatar)].radius_m;
  // The sum of three even draws is near a normal one, and bounded.
  const float spread =
      (town->random.Uniform(-1, 1) + town->random.Uniform(-1, 1) + town->random.Uniform(-1, 1)) * c.speed_spread_mps;
  p.top_mps = c.top_speed_mps;
  p.preferred_mps = std::clamp(c.preferred_speed_mps + spread, 0.5f * c.preferred_speed_mps, c.top_speed_mps);
  p.heading_rad = town->random.Uniform(-kPi, kPi);
  return p;
}

int DrawCompany(int most, Town* town) {
  const float share = town->settings.group_share;
  if (share <= 0) return 1;
  // So many of the arrivals are groups that `share` of the people are in one.
  if (town->random.Uniform() >= share / (kMeanGroup - share * (kMeanGroup - 1))) return 1;
  const float draw = town->random.Uniform();
  const int size = draw < kShareOfTwo ? 2 : draw < kShareOfTwo + kShareOfThree ? 3 : 4;
  return std::min(size, most);
}

void AddToTown(Person person, PersonPlan plan, Town* town) {
  person.reach_m = town->residents[static_cast<size_t>(person.avatar)].reach_m;
  plan.id = AddPerson(person, &town->crowd);
  town->crowd.view.back() = ViewClass::kOutside;
  EntryOf(town->crowd.slot.back(), plan.id, &town->plans) = std::move(plan);
}

Error PlaceScenarioPeople(const std::vector<ScenarioPerson>& persons, Town* town) {
  const size_t first = town->crowd.size();
  for (size_t k = 0; k < persons.size(); ++k) {
    if (Error e = TakeScenarioPerson(persons[k], "person " + std::to_string(k + 1), town)) return e;
  }
  return JoinScenarioPeople(persons, first, town);
}

void PlaceCrowd(int wanted, const Viewer& viewer, Town* town) {
  town->target_people = static_cast<int>(town->crowd.size()) + wanted;
  if (wanted == 0) return;
  PreparePlaces(town);
  PrepareLoitering(town);
  PrepareWork(town);
  BeginOutlook(static_cast<int>(town->crowd.size()) + wanted, viewer, town);
  int placed = PlaceWorkers(wanted, viewer, town);
  placed += PlacePlayers(wanted - placed, town);
  const int standing = static_cast<int>(town->settings.loiter_share * static_cast<float>(wanted));
  const int about = std::min(standing, wanted - placed);
  for (int tries = 0, stand = 0; tries < 2 * about && stand < about; ++tries) {
    const int company = DrawCompany(about - stand, town);
    if (!PlaceLoiterers(company, viewer, town)) continue;
    stand += company;
    placed += company;
  }
  Spots spots = MakeSpots(town);
  while (placed < wanted) {
    const int company = PlaceCompany(DrawCompany(wanted - placed, town), viewer, &spots, town);
    placed += company;
    if (company > 0) continue;
    town->warnings.push_back("only " + std::to_string(placed) + " of " + std::to_string(wanted) +
                             " people fit on the walkable ground");
    town->target_people = static_cast<int>(town->crowd.size());
    return;
  }
}

}  // namespace flaneur
