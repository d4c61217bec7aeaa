// What a step of the crowd costs. The open field is the setting that other crowds are measured in: 0.3 people/m^2,
// everybody with full behaviour, 36 circles of 1 to 2 m, steps of 1/30 s, one thread.
#include <benchmark/benchmark.h>

#include "runtime/base/clock.h"
#include "runtime/control/level_control.h"
#include "runtime/crowd/constants.h"
#include "tests/bench/time_steps.h"
#include "tests/unit/runtime/crowd/open_field.h"

namespace flaneur {
namespace {

constexpr int kWarmUp_steps = 150, kSteps = 300;

// As whoever keeps a large crowd does.
void SortAndStep(OpenField* field) {
  if (field->crowd.step % kSortEvery_steps == 0) SortBySpace(&field->scratch, &field->crowd);
  StepOpenField(field);
}

// Under way for a while, all ways known.
OpenField BusyField(int people) {
  OpenField field = MakeOpenField(people, people > 10000 ? 4 : 8);
  for (int f : field.fields) BuildField(field.walkable, f, &field.crowd);
  for (int i = 0; i < kWarmUp_steps; ++i) SortAndStep(&field);
  return field;
}

void OpenFieldStep(benchmark::State& state) {
  OpenField field = BusyField(static_cast<int>(state.range(0)));
  TimeSteps(state, [&] { SortAndStep(&field); });
}
BENCHMARK(OpenFieldStep)->Arg(1000)->Arg(10000)->Arg(100000)->Iterations(kSteps)->Unit(benchmark::kMillisecond);

// The same with so many threads beside the caller's.
void OpenFieldStepOfThreads(benchmark::State& state) {
  OpenField field = BusyField(100'000);
  Jobs jobs(static_cast<size_t>(state.range(0)));
  const auto step = [&] {
    if (field.crowd.step % kSortEvery_steps == 0) SortBySpace(&field.scratch, &field.crowd);
    StepOpenField(&field, &jobs);
  };
  TimeSteps(state, step, Now_ms);
}
BENCHMARK(OpenFieldStepOfThreads)
    ->Arg(0)
    ->Arg(1)
    ->Arg(3)
    ->Iterations(kSteps)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

// So many people are sent somewhere else in the same frame; with the step that follows, in which all of them set out.
void NewGoals(benchmark::State& state) {
  OpenField field = BusyField(10000);
  TimeSteps(state, [&] {
    for (size_t i = 0; i < static_cast<size_t>(state.range(0)); ++i) SetGoal(i, SomePlace(&field), &field.crowd);
    SortAndStep(&field);
  });
}
BENCHMARK(NewGoals)->Arg(0)->Arg(1000)->Arg(10000)->Iterations(100)->Unit(benchmark::kMillisecond);

void LevelChoice(benchmark::State& state) {
  const OpenField field = MakeOpenField(static_cast<int>(state.range(0)));
  const std::vector<AvatarCosts> avatars{{{{10000, 90}, {5000, 60}, {1000, 0}}, 1.75f, 128}};
  LevelState levels;
  for (auto _ : state) {
    ChooseLevels(field.crowd, avatars, {}, {.camera = {{10, 10}, 0.8f, 1.05f}, .motion = {{1, 1}}}, &levels);
    benchmark::DoNotOptimize(levels.triangles);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(LevelChoice)->Arg(1000)->Arg(10000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flaneur
