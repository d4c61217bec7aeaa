// Cost of one step of the crowd and of choosing everybody's level, per number of people. Prints people per second: near linear
// cost shows as the same figure for all numbers.
#include <benchmark/benchmark.h>

#include <cmath>

#include "runtime/control/level_control.h"
#include "runtime/crowd/crowd.h"

namespace flaneur {
namespace {

constexpr float kStep_s = 1.0f / 30;
constexpr float kDensity_pm2 = 0.25f;  // a busy square

// An open square, as large as the people need at the same density, with a house in every 20 m.
Walkable Square(int people) {
  const float side_m = std::sqrt(static_cast<float>(people) / kDensity_pm2);
  Walkable w;
  const int cells = static_cast<int>(side_m / 0.5f);
  w.ground = {{0, 0}, 0.5f, cells, cells, std::vector<float>(static_cast<size_t>(cells * cells), 0.0f),
              std::vector<uint8_t>(static_cast<size_t>(cells * cells), 3)};
  for (float x = 10; x + 6 < side_m; x += 20) {
    for (float y = 10; y + 6 < side_m; y += 20) w.polygons.push_back({{{x, y}, {x + 6, y}, {x + 6, y + 6}, {x, y + 6}}, {}});
  }
  BuildWalkable(0.3f, &w);
  return w;
}

Crowd People(const Walkable& w, int people) {
  Crowd crowd;
  const float side_m = static_cast<float>(w.columns) * w.cell_m;
  uint32_t state = 1;
  const auto random = [&] {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 8) / 16777216.0f;
  };
  while (static_cast<int>(crowd.size()) < people) {
    Person p;
    p.position = {random() * side_m, random() * side_m};
    if (!IsFree(w, p.position)) continue;
    p.field = FieldFor({random() < 0.5f ? 1.0f : side_m - 1, std::floor(random() * 4) * side_m / 4 + 1}, &crowd);
    AddPerson(p, &crowd);
    crowd.view.back() = ViewClass::kVisible;
  }
  return crowd;
}

void CrowdStep(benchmark::State& state) {
  const Walkable w = Square(static_cast<int>(state.range(0)));
  Crowd crowd = People(w, static_cast<int>(state.range(0)));
  for (int i = 0; i < 30; ++i) StepCrowd(w, {}, kStep_s, &crowd);
  for (auto _ : state) StepCrowd(w, {}, kStep_s, &crowd);
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(CrowdStep)->Arg(1000)->Arg(4000)->Arg(10000)->Unit(benchmark::kMillisecond);

void LevelChoice(benchmark::State& state) {
  const Walkable w = Square(static_cast<int>(state.range(0)));
  const Crowd crowd = People(w, static_cast<int>(state.range(0)));
  const std::vector<AvatarCosts> avatars{{{{10000, 90}, {5000, 60}, {1000, 0}}, 1.75f, 128}};
  LevelState levels;
  for (auto _ : state) {
    ChooseLevels(crowd, avatars, {{10, 10}, 0.8f, 1.05f}, 1.4f, 0, {}, kStep_s, &levels);
    benchmark::DoNotOptimize(levels.triangles);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(LevelChoice)->Arg(1000)->Arg(10000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flaneur
