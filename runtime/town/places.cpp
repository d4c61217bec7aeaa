#include "runtime/town/places.h"

#include <algorithm>

#include "runtime/town/loitering.h"
#include "runtime/town/painted.h"
#include "runtime/town/ways_out.h"
#include "runtime/town/work.h"

namespace flaneur {
namespace {

constexpr int kMadeUpGoals = 24;  // where a town names no places
constexpr float kReach_m = 2.5f;  // from a place to where people can stand
constexpr float kWorthWalking_m = 8;
constexpr float kPacked_pm2 = 1.4f;  // nobody chooses a way through such a crowd who has the choice
constexpr float kToPaint = 0.75f;    // of those who go somewhere, where goals are painted; the others leave the town
constexpr float kWorseThanCrowds = 100;
constexpr int kTries = 8;  // for somewhere worth walking to

void SortPlaces(Town* town) {
  PlaceLists& lists = town->place_lists;
  lists = {};
  for (int k = 0; k < static_cast<int>(town->places.size()); ++k) {
    const Place& place = town->places[static_cast<size_t>(k)];
    if (place.kind == "work") {
      lists.works.push_back(k);
      continue;
    }
    if (place.kind == "play") {
      lists.plays.push_back(k);
      continue;
    }
    lists.all.push_back(k);
    if (IsGate(place)) lists.gates.push_back(k);
    if (place.kind == "goal") lists.goals.push_back(k);
    if (place.kind == "loiter") lists.loiters.push_back(k);
    if (place.kind == "spawn") lists.spawns.push_back(k);
    if (place.kind != "loiter" && place.kind != "spawn") lists.destinations.push_back(k);
  }
}

void MakeUpGoals(Town* town) {
  const std::vector<int> cells = HomeCells(*town);
  for (int k = 0; k < kMadeUpGoals && !cells.empty(); ++k) {
    const int cell = cells[static_cast<size_t>(town->random.Below(static_cast<int>(cells.size())))];
    town->places.push_back({"goal_" + std::to_string(k + 1), "goal", CellCenter(town->walkable, cell), 1});
  }
}

// 0 for a goal that is worth walking to now.
float DrawbackOf(const Viewer& viewer, Vec2 from, Vec2 goal, const Town& town) {
  const float crowd_pm2 = MostDensityBetween_pm2(town.density, from, goal);
  const float crowded = crowd_pm2 < kPacked_pm2 ? 0 : crowd_pm2;
  if (IsFullNear(viewer, town, goal)) return crowded + kWorseThanCrowds;
  return Length(goal - from) < kWorthWalking_m ? crowded + 2 * kWorseThanCrowds : crowded;
}

// Drawn from by whoever goes somewhere.
const std::vector<int>& Destinations(bool loiter, Town* town) {
  const PlaceLists& lists = town->place_lists;
  const std::vector<int>* choices = loiter ? &lists.loiters : town->crowd_area ? &lists.goals : &lists.destinations;
  const bool painted = !lists.goals.empty() && town->painting.columns > 0;
  if (!loiter && painted && town->random.Uniform() < kToPaint) choices = &lists.goals;
  return choices->empty() ? lists.all : *choices;
}

const std::string& Called(const Place& place) { return place.name.empty() ? place.kind : place.name; }

// A place of work may be where nobody walks, as behind a counter, if whoever works there never comes or goes.
bool IsWhereItCanBe(const Place& place, bool reachable, const Town& town) {
  if (place.kind != "work" || RoomAt_m(town.walkable, place.position_m) < kLeastWorkRoom_m) return false;
  return OnGround(town.walkable, place.position_m) && (place.stay_s <= 0 || reachable);
}

}  // namespace

int LargestComponent(const Walkable& w) {
  std::vector<int> size;
  for (int c : w.component) {
    if (c < 0) continue;
    if (static_cast<size_t>(c) >= size.size()) size.resize(static_cast<size_t>(c) + 1, 0);
    ++size[static_cast<size_t>(c)];
  }
  return size.empty() ? -1 : static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
}

int BestFreeCell(const Walkable& w) {
  const int main_component = LargestComponent(w);
  const auto of_town = [&](size_t cell) { return main_component >= 0 && w.component[cell] == main_component; };
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

std::vector<int> HomeCells(const Town& town) {
  const int main_component = LargestComponent(town.walkable);
  std::vector<int> cells;
  for (size_t c = 0; c < town.walkable.component.size(); ++c) {
    const int cell = static_cast<int>(c);
    if (town.walkable.component[c] != main_component) continue;
    if (!town.crowd_area || Contains(*town.crowd_area, CellCenter(town.walkable, cell))) cells.push_back(cell);
  }
  return cells;
}

void PreparePlaces(Town* town) {
  const int main_component = LargestComponent(town->walkable);
  std::vector<Place> kept;
  for (Place& place : town->places) {
    if (town->crowd_area && !Contains(*town->crowd_area, place.position_m)) continue;
    const int cell = NearestFreeCell(town->walkable, place.position_m, kReach_m);
    const bool reachable = cell >= 0 && town->walkable.component[static_cast<size_t>(cell)] == main_component;
    if (IsWhereItCanBe(place, reachable, *town)) {
      kept.push_back(place);
      continue;
    }
    if (!reachable) {
      town->warnings.push_back("place '" + Called(place) + "' cannot be reached; it is not used");
      continue;
    }
    if (!IsGate(place) && InsideObstacle(town->walkable, place.position_m)) {
      town->warnings.push_back("place '" + Called(place) + "' (" + place.kind +
                               ") is inside an obstacle; the nearest free ground is taken");
    }
    place.position_m = CellCenter(town->walkable, cell);
    kept.push_back(place);
  }
  town->places = std::move(kept);
  AddPaintedPlaces(town);
  SortPlaces(town);
  if (town->crowd_area ? !town->place_lists.goals.empty() : !town->place_lists.all.empty()) return;
  MakeUpGoals(town);
  SortPlaces(town);
}

int PlaceOfField(int field, Town* town) {
  if (field < 0) return -1;
  for (size_t f = town->place_of_field.size(); f < town->crowd.fields.size(); ++f) {
    const Vec2 goal = town->crowd.fields[f].goal;
    const auto found = std::find_if(town->places.begin(), town->places.end(), [&](const Place& place) {
      return place.position_m.x == goal.x && place.position_m.y == goal.y;
    });
    town->place_of_field.push_back(found != town->places.end() ? static_cast<int>(found - town->places.begin()) : -1);
  }
  return town->place_of_field[static_cast<size_t>(field)];
}

int AnyDestination(Vec2 from, Town* town) {
  const std::vector<int>& choices = Destinations(false, town);
  if (choices.empty()) return -1;
  const int chosen = choices[static_cast<size_t>(town->random.Below(static_cast<int>(choices.size())))];
  const Vec2 goal = town->places[static_cast<size_t>(chosen)].position_m;
  if (Length(goal - from) < kWorthWalking_m || MostDensityBetween_pm2(town->density, from, goal) >= kPacked_pm2)
    return -1;
  return FieldFor(goal, &town->crowd);
}

int PickDestination(const Viewer& viewer, Vec2 from, bool may_loiter, Town* town) {
  const bool loiter = may_loiter && FewLoiter(*town) && town->random.Uniform() < 0.5f;
  const std::vector<int>* choices = &Destinations(loiter, town);
  int best = -1;
  float least = 0;
  for (int attempt = 0; attempt < kTries && !choices->empty(); ++attempt) {
    const int chosen = (*choices)[static_cast<size_t>(town->random.Below(static_cast<int>(choices->size())))];
    const Vec2 goal = town->places[static_cast<size_t>(chosen)].position_m;
    float drawback = DrawbackOf(viewer, from, goal, *town);
    if (town->outlook.is_full && drawback < kWorseThanCrowds) {
      const float in_the_way =
          InTheWay(viewer, *town, from, FieldFor(goal, &town->crowd), town->settings.preferred_speed_mps);
      drawback += std::min(in_the_way, kWorseThanCrowds / 2);
    }
    if (best < 0 || drawback < least) best = chosen, least = drawback;
    if (least <= 0) break;
  }
  return best < 0 ? -1 : FieldFor(town->places[static_cast<size_t>(best)].position_m, &town->crowd);
}

}  // namespace flaneur
