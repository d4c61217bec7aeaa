#include "runtime/player/population.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

constexpr int kMadeUpGoals = 24;            // where a town names no places
constexpr float kLeastWait_s = 15, kMostWait_s = 50;
constexpr float kBirthGap_m = 0.3f;         // between a newcomer and everybody else, beyond touching
constexpr int kTries = 40;                  // to find a free spot before giving up for now
constexpr int kBirths_perStep = 2;
constexpr float kTalkingDistance_m = 2.5f;

int LargestComponent(const Walkable& w) {
  std::vector<int> size;
  for (int c : w.component) {
    if (c < 0) continue;
    if (static_cast<size_t>(c) >= size.size()) size.resize(static_cast<size_t>(c) + 1, 0);
    ++size[static_cast<size_t>(c)];
  }
  return size.empty() ? -1 : static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
}

bool Crowded(const Crowd& crowd, Vec2 p, float radius_m) {
  for (size_t i = 0; i < crowd.size(); ++i) {
    const float reach_m = radius_m + crowd.radius_m[i] + kBirthGap_m;
    const Vec2 off = crowd.position[i] - p;
    if (Dot(off, off) < reach_m * reach_m) return true;
  }
  return false;
}

bool IsGate(const PackPlace& place) { return place.kind == "door" || place.kind == "exit"; }

std::vector<size_t> PlacesWhere(const Simulation& s, bool (*test)(const PackPlace&)) {
  std::vector<size_t> found;
  for (size_t i = 0; i < s.places.size(); ++i) {
    if (test(s.places[i])) found.push_back(i);
  }
  return found;
}

bool IsLoiter(const PackPlace& place) { return place.kind == "loiter"; }
bool IsGoal(const PackPlace& place) { return place.kind == "goal"; }
bool IsDestination(const PackPlace& place) { return place.kind != "loiter" && place.kind != "spawn"; }
bool IsAny(const PackPlace&) { return true; }

// The walkable cells where people may live.
std::vector<int> HomeCells(const Simulation& s) {
  const int town = LargestComponent(s.walkable);
  std::vector<int> cells;
  for (size_t c = 0; c < s.walkable.component.size(); ++c) {
    const int cell = static_cast<int>(c);
    if (s.walkable.component[c] != town) continue;
    if (!s.crowd_area || Contains(*s.crowd_area, CellCenter(s.walkable, cell))) cells.push_back(cell);
  }
  return cells;
}

// Places nobody can get to are dropped with a warning; a town without any gets some made up, and so does a crowd's own area.
void PreparePlaces(Simulation* s) {
  const int town = LargestComponent(s->walkable);
  std::vector<PackPlace> kept;
  for (PackPlace& place : s->places) {
    const int cell = NearestFreeCell(s->walkable, place.position_m, 2.5f);
    if (cell < 0 || s->walkable.component[static_cast<size_t>(cell)] != town) {
      s->warnings.push_back("place '" + place.name + "' cannot be reached; it is not used");
      continue;
    }
    if (s->crowd_area && !Contains(*s->crowd_area, place.position_m)) continue;
    place.position_m = CellCenter(s->walkable, cell);
    kept.push_back(place);
  }
  s->places = std::move(kept);
  if (s->crowd_area ? !PlacesWhere(*s, IsGoal).empty() : !s->places.empty()) return;
  const std::vector<int> cells = HomeCells(*s);
  for (int k = 0; k < kMadeUpGoals && !cells.empty(); ++k) {
    const int cell = cells[static_cast<size_t>(s->random.Below(static_cast<int>(cells.size())))];
    s->places.push_back({"goal_" + std::to_string(k + 1), "goal", CellCenter(s->walkable, cell), 1});
  }
}

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

int PickDestination(Simulation* s, Vec2 from, bool may_loiter) {
  const bool loiter = may_loiter && s->random.Uniform() < s->crowd_settings.loiter_share * 2;
  auto choices = PlacesWhere(*s, loiter ? IsLoiter : s->crowd_area ? IsGoal : IsDestination);
  if (choices.empty()) choices = PlacesWhere(*s, IsAny);
  for (int attempt = 0; attempt < 8; ++attempt) {
    const PackPlace& place = s->places[choices[static_cast<size_t>(s->random.Below(static_cast<int>(choices.size())))]];
    if (Length(place.position_m - from) < 8 && attempt < 7) continue;  // somewhere worth walking to
    return FieldFor(place.position_m, &s->crowd);
  }
  return -1;
}

const PackPlace* PlaceAt(const Simulation& s, Vec2 goal) {
  for (const PackPlace& place : s.places) {
    if (place.position_m.x == goal.x && place.position_m.y == goal.y) return &place;
  }
  return nullptr;
}

void Add(const Person& person, PersonPlan plan, Simulation* s) {
  AddPerson(person, &s->crowd);
  s->crowd.view.back() = ViewClass::kOutside;
  s->plans.push_back(std::move(plan));
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

// True where the person is done and leaves the scene.
bool NextForArrived(size_t i, Simulation* s) {
  Crowd& c = s->crowd;
  PersonPlan& plan = s->plans[static_cast<size_t>(c.id[i])];
  if (!plan.goals.empty()) {
    SetGoal(i, FieldFor(plan.goals.front(), &c), &c);
    plan.goals.erase(plan.goals.begin());
    return false;
  }
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
  SetGoal(i, PickDestination(s, c.position[i], true), &c);
  return false;
}

void Birth(Simulation* s) {
  const auto gates = PlacesWhere(*s, IsGate);
  if (gates.empty()) return;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const PackPlace& gate = s->places[gates[static_cast<size_t>(s->random.Below(static_cast<int>(gates.size())))]];
    const bool seen = s->camera.present &&
                      Classify(gate.position_m, s->camera.view, s->outer_apex_back_m) != ViewClass::kOutside;
    if (seen) continue;
    Person p = NewPerson(s);
    if (Crowded(s->crowd, gate.position_m, p.radius_m)) continue;
    p.position = gate.position_m;
    p.field = PickDestination(s, p.position, true);
    Add(p, PersonPlan{{}, false, false}, s);
    return;
  }
}

// Marks the cell of somebody placed exactly, and those around it, as they need not stand in its middle.
void TakeAround(const Walkable& w, Vec2 p, std::vector<char>* taken) {
  for (int k = 0; k < 9; ++k) {
    const int cell = CellAt(w, p + Vec2{static_cast<float>(k % 3 - 1), static_cast<float>(k / 3 - 1)} * w.cell_m);
    if (cell >= 0) (*taken)[static_cast<size_t>(cell)] = 1;
  }
}

}  // namespace

int BestFreeCell(const Walkable& w) {
  const int town = LargestComponent(w);
  const auto of_town = [&](size_t cell) { return town >= 0 && w.component[cell] == town; };
  Vec2 sum;
  float count = 0;
  for (size_t c = 0; c < w.component.size(); ++c) {
    if (!of_town(c)) continue;
    sum = sum + CellCenter(w, static_cast<int>(c));
    count += 1;
  }
  int best = -1;
  float best_m = 0;
  for (size_t c = 0; c < w.component.size(); ++c) {
    if (!of_town(c)) continue;
    const float away_m = Length(CellCenter(w, static_cast<int>(c)) - sum * (1 / count));
    if (best < 0 || away_m < best_m) best = static_cast<int>(c), best_m = away_m;
  }
  return best;
}

Error PlaceScenarioPeople(const Scenario& scenario, Simulation* s) {
  for (size_t k = 0; k < scenario.persons.size(); ++k) {
    const ScenarioPerson& wanted = scenario.persons[k];
    const std::string name = "person " + std::to_string(k + 1);
    Person p;
    if (!wanted.avatar.empty()) {
      const auto found = std::find(s->avatar_names.begin(), s->avatar_names.end(), wanted.avatar);
      if (found != s->avatar_names.end()) p.avatar = static_cast<int>(found - s->avatar_names.begin());
      else if (s->avatar_names != std::vector<std::string>{kPlainFigure}) return Fail(name + ": there is no avatar '" + wanted.avatar + "'");
    }
    p.radius_m = wanted.radius_m > 0 ? wanted.radius_m : s->avatar_radius_m[static_cast<size_t>(p.avatar)];
    p.preferred_mps = wanted.speed_mps > 0 ? wanted.speed_mps : s->crowd_settings.preferred_speed_mps;
    p.top_mps = wanted.top_speed_mps > 0 ? wanted.top_speed_mps : std::max(s->crowd_settings.top_speed_mps, p.preferred_mps);
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
      const Vec2 way = s->crowd.fields[static_cast<size_t>(p.field)].goal - p.position;
      p.heading_rad = std::atan2(way.y, way.x);
    }
    Add(p, std::move(plan), s);
  }
  return Ok();
}

void PlaceCrowd(Simulation* s) {
  s->target_people = static_cast<int>(s->crowd.size()) + s->crowd_settings.people;
  if (s->crowd_settings.people == 0) return;
  PreparePlaces(s);
  std::vector<int> cells = HomeCells(*s);
  for (size_t k = cells.size(); k > 1; --k) {
    std::swap(cells[k - 1], cells[static_cast<size_t>(s->random.Below(static_cast<int>(k)))]);
  }
  // Cells of the navigation grid are apart by half a metre: marking those taken keeps starting linear in people.
  std::vector<char> taken(s->walkable.cost.size(), 0);
  for (const Vec2 p : s->crowd.position) TakeAround(s->walkable, p, &taken);
  size_t next = 0;
  for (int k = 0; k < s->crowd_settings.people; ++k) {
    Person p = NewPerson(s);
    const int reach = static_cast<int>(std::ceil(2 * p.radius_m / s->walkable.cell_m));
    const auto free = [&](int cell) {
      for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
          const int other = cell + y * s->walkable.columns + x;
          if (other >= 0 && other < static_cast<int>(taken.size()) && taken[static_cast<size_t>(other)]) return false;
        }
      }
      const Vec2 off = CellCenter(s->walkable, cell) - s->camera.view.position;
      return !s->camera.present || Length(off) > s->r_personal_m + p.radius_m + 0.5f;
    };
    while (next < cells.size() && !free(cells[next])) ++next;
    if (next == cells.size()) {
      s->warnings.push_back("only " + std::to_string(k) + " of " + std::to_string(s->crowd_settings.people) +
                            " people fit on the walkable ground");
      s->target_people = static_cast<int>(s->crowd.size());
      return;
    }
    taken[static_cast<size_t>(cells[next])] = 1;
    p.position = CellCenter(s->walkable, cells[next]);
    p.field = PickDestination(s, p.position, true);
    if (p.field >= 0) {
      const Vec2 way = s->crowd.fields[static_cast<size_t>(p.field)].goal - p.position;
      p.heading_rad = std::atan2(way.y, way.x);
    }
    Add(p, PersonPlan{{}, false, false}, s);
  }
}

void LeaveAndArrive(Simulation* s) {
  Crowd& c = s->crowd;
  for (size_t i = 0; i < c.size();) {
    if (c.activity[i] != Activity::kWalking && c.wait_s[i] <= 0 && c.field[i] < 0 &&
        !s->plans[static_cast<size_t>(c.id[i])].leaves) {
      SetGoal(i, PickDestination(s, c.position[i], false), &c);
    }
    if (c.arrived[i] && NextForArrived(i, s)) {
      RemovePerson(i, &c);
      continue;
    }
    ++i;
  }
  for (int k = 0; k < kBirths_perStep && static_cast<int>(c.size()) < s->target_people; ++k) Birth(s);
}

}  // namespace flaneur
