// The demo town with view classes on: most people only follow their ways. A small town cannot hold 100,000 people, so
// it is enlarged until everybody has their share of the ground at 0.3 people/m^2. FLANEUR_PACK names the tour pack.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>

#include "runtime/control/view_volumes.h"
#include "runtime/crowd/constants.h"
#include "runtime/pack/tour_pack.h"
#include "tests/bench/time_steps.h"
#include "tests/unit/runtime/crowd/open_field.h"

namespace flaneur {
namespace {

// Whether a way leads from the cell to the first goal.
bool IsReached(const Walkable& w, const Crowd& crowd, size_t cell) {
  return w.cost[cell] > 0 && Reachable(w, crowd.fields[0], CellCenter(w, static_cast<int>(cell)));
}

constexpr float kDensity_pm2 = 0.3f, kTurn_radps = 0.5f, kOuterApexBack_m = 20;
constexpr int kWarmUp_steps = 150;
constexpr size_t kGoals = 24;

struct Town {
  Walkable walkable;
  Crowd crowd;
  CrowdScratch scratch;
  std::vector<int> fields;
  ViewCamera camera;
  Random random{1};
};

float WalkableArea_m2(const Walkable& w) {
  float cells = 0;
  for (float cost : w.cost) cells += cost > 0 ? 1.0f : 0.0f;
  return cells * w.cell_m * w.cell_m;
}

void TakeTown(const TourPack& pack, float scale, Walkable* w) {
  const auto scaled = [&](std::vector<Vec2> ring) {
    for (Vec2& p : ring) p = p * scale;
    return ring;
  };
  *w = {};
  const GroundRaster& ground = *pack.ground;
  w->ground =
      Share({ground.min_m * scale, ground.cell_m * scale, ground.columns, ground.rows, ground.height_m, ground.kind});
  for (const CircleObstacle& o : pack.obstacles.circles) w->circles.push_back({o.center * scale, o.radius_m});
  for (const PolygonObstacle& o : pack.obstacles.polygons) {
    w->polygons.push_back({scaled(o.outer), {}});
    for (const auto& hole : o.holes) w->polygons.back().holes.push_back(scaled(hole));
  }
  BuildWalkable(0.3f, w, 0.25f);
}

int SomeField(Town* t) { return t->fields[static_cast<size_t>(t->random.Below(static_cast<int>(t->fields.size())))]; }

void Settle(const TourPack& pack, int people, float scale, Town* t) {
  const size_t every =
      std::max<size_t>(1, pack.places.size() / kGoals);  // all over the town, as people's destinations are
  for (size_t k = 0; k < pack.places.size(); k += every) {
    const int cell = NearestFreeCell(t->walkable, pack.places[k].position_m * scale, 3 * scale);
    if (cell >= 0) t->fields.push_back(FieldFor(CellCenter(t->walkable, cell), &t->crowd));
  }
  for (int f : t->fields) BuildField(t->walkable, f, &t->crowd);
  std::vector<int> cells;
  for (size_t cell = 0; cell < t->walkable.cost.size(); ++cell) {
    if (IsReached(t->walkable, t->crowd, cell)) cells.push_back(static_cast<int>(cell));
  }
  for (int k = 0; k < people; ++k) {
    Person p;
    p.position = CellCenter(t->walkable, cells[static_cast<size_t>(t->random.Below(static_cast<int>(cells.size())))]);
    p.preferred_mps = t->random.Uniform(1.1f, 1.5f);
    p.field = SomeField(t);
    AddPerson(p, &t->crowd);
  }
  t->camera = {CellCenter(t->walkable, cells[cells.size() / 2]), 0, 1.0472f};
}

void StepTown(Town* t) {
  t->camera.yaw_rad = std::remainder(t->camera.yaw_rad + kTurn_radps * kOpenFieldStep_s, 2 * kPi);
  const ViewVolumes volumes = VolumesOf(t->camera, kOuterApexBack_m);
  for (size_t i = 0; i < t->crowd.size(); ++i)
    t->crowd.view[i] = Classify(t->crowd.position[i], t->crowd.reach_m[i], volumes);
  t->crowd.viewer = t->camera.position;
  if (t->crowd.step % kSortEvery_steps == 0) SortBySpace(&t->scratch, &t->crowd);
  StepCrowd(t->walkable, {{t->camera.position, 0.6f, true, {}}}, kOpenFieldStep_s, &t->scratch, &t->crowd);
  for (size_t i = 0; i < t->crowd.size(); ++i) {
    if (t->crowd.arrived[i] != Arrival::kNot) SetGoal(i, SomeField(t), &t->crowd);
  }
}

// A town that is large enough, with everybody under way; false where there is no pack.
bool BusyTown(int people, benchmark::State& state, Town* town) {
  const char* path = std::getenv("FLANEUR_PACK");
  TourPack pack;
  if (path == nullptr || LoadTourPack(path, {false}, &pack)) {
    state.SkipWithError("FLANEUR_PACK names no tour pack");
    return false;
  }
  TakeTown(pack, 1, &town->walkable);
  const float scale =
      std::max(1.0f, std::sqrt(static_cast<float>(people) / kDensity_pm2 / WalkableArea_m2(town->walkable)));
  TakeTown(pack, scale, &town->walkable);
  Settle(pack, people, scale, town);
  town->crowd.r_unimportant_m = pack.control.r_unimportant_m;
  town->crowd.r_far_m = pack.control.r_far_m;
  for (int i = 0; i < kWarmUp_steps; ++i) StepTown(town);
  return true;
}

void TownStep(benchmark::State& state) {
  Town town;
  if (!BusyTown(static_cast<int>(state.range(0)), state, &town)) return;
  double shown = 0;
  TimeSteps(state, [&] {
    StepTown(&town);
    shown += static_cast<double>(town.scratch.caring.size());
  });
  state.counters["full_behaviour"] = shown / static_cast<double>(state.iterations());
}
BENCHMARK(TownStep)->Arg(1000)->Arg(10000)->Arg(100000)->Iterations(376)->Unit(benchmark::kMillisecond);

// So many people are sent somewhere in the same frame, each to a goal that nobody else has; with the step in which they
// set out. `granted`: the share of them who know their way after it.
void TownNewGoals(benchmark::State& state) {
  Town town;
  if (!BusyTown(10000, state, &town)) return;
  std::vector<int> cells;
  for (size_t cell = 0; cell < town.walkable.cost.size(); ++cell) {
    if (IsReached(town.walkable, town.crowd, cell)) cells.push_back(static_cast<int>(cell));
  }
  const size_t sent = static_cast<size_t>(state.range(0));
  double granted = 0;
  TimeSteps(state, [&] {
    for (size_t i = 0; i < sent; ++i) {
      const int cell = cells[static_cast<size_t>(town.random.Below(static_cast<int>(cells.size())))];
      SetGoal(i, FieldFor(CellCenter(town.walkable, cell), &town.crowd), &town.crowd);
    }
    StepTown(&town);
    for (size_t i = 0; i < sent; ++i) granted += Length(town.crowd.way[i]) > 0 ? 1 : 0;
  });
  state.counters["granted"] = granted / static_cast<double>(state.iterations()) / static_cast<double>(sent);
}
BENCHMARK(TownNewGoals)->Arg(1000)->Iterations(5)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flaneur
