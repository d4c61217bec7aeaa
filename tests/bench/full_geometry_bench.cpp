// What drawing people by level saves: bench_full_geometry PACK SCENARIO [PEOPLE [PICTURES [RUNS
// [WIDTHxHEIGHT[@SCALE]]]]]
//
// Plays the scenario RUNS times (3), each time with another crowd, and draws PICTURES of it (20), spread evenly over
// the walk: as control decides, with everybody who is drawn as their finest mesh, and without anybody. Each is drawn
// once unmeasured before, so that shadows and buffers are those of a walk that goes on. Prints medians of the pictures,
// what the town alone takes of ours, and the median of the pictures' own ratios with that of every run. SCALE:
// FrameInput::resolution_scale.
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "runtime/base/clock.h"
#include "runtime/desktop/context.h"
#include "runtime/render/renderer.h"
#include "runtime/show/frame_from_simulation.h"
#include "runtime/simulation/scenario.h"
#include "runtime/simulation/simulation.h"

namespace flaneur {
namespace {

constexpr float kLongest_s = 600;  // of a walk that has no end

struct Cost {
  double clock_ms = 0, processor_ms = 0;
};

struct Pair {
  Cost ours, full, town;
  int64_t our_triangles = 0, full_triangles = 0;
};

double Processor_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double MedianOf(const std::vector<Pair>& pairs, auto value) {
  std::vector<double> values;
  for (const Pair& p : pairs) values.push_back(value(p));
  return Median(std::move(values));
}

struct Setting {
  int pictures = 20, runs = 3, width_px = 1280, height_px = 720;
  float scale = 1;
};

Cost Measured(const FrameInput& frame, const Setting& setting, Renderer* renderer, FrameStatistics* statistics) {
  renderer->Draw(frame, setting.width_px, setting.height_px, statistics);
  const double clock_ms = Now_ms(), processor_ms = Processor_ms();
  renderer->Draw(frame, setting.width_px, setting.height_px, statistics);
  return {Now_ms() - clock_ms, Processor_ms() - processor_ms};
}

Pair Draw(FrameInput frame, const Setting& setting, Renderer* renderer) {
  Pair pair;
  FrameStatistics statistics;
  frame.resolution_scale = setting.scale;
  pair.ours = Measured(frame, setting, renderer, &statistics);
  pair.our_triangles = statistics.people_triangles;
  FrameInput full = frame;
  for (DrawnPerson& p : full.people) p.level = MeshLevel(0);
  full.keeps_levels = true;
  pair.full = Measured(full, setting, renderer, &statistics);
  pair.full_triangles = statistics.people_triangles;
  frame.people.clear();
  pair.town = Measured(frame, setting, renderer, &statistics);
  return pair;
}

Error StepsOfWalk(const TourPack& pack, const Scenario& scenario, int64_t* steps) {
  Simulation s;
  if (Error e = StartSimulation(&pack, scenario, &s)) return e;
  const float end_s = scenario.seconds.value_or(kLongest_s);
  while (!s.visitor.finished && static_cast<float>(s.town.step) * Step_s(s) < end_s) StepSimulation({}, 0, &s);
  *steps = s.town.step;
  return Ok();
}

Error Play(const TourPack& pack, const Scenario& scenario, const Setting& setting, Renderer* renderer,
           std::vector<Pair>* pairs) {
  int64_t steps = 0;
  if (Error e = StepsOfWalk(pack, scenario, &steps)) return e;
  Simulation s;
  if (Error e = StartSimulation(&pack, scenario, &s)) return e;
  PersonLooks looks;
  FrameInput frame;
  for (int k = 0; k < setting.pictures; ++k) {
    while (s.town.step * setting.pictures < k * steps) {
      FrameFromSimulation(pack, s, &looks, &frame);  // who fades, fades from step to step
      StepSimulation({}, 0, &s);
    }
    FrameFromSimulation(pack, s, &looks, &frame);
    pairs->push_back(Draw(frame, setting, renderer));
  }
  return Ok();
}

void Print(const std::vector<Pair>& all, const std::vector<double>& ratios_of_runs) {
  const auto ratio = [](const Pair& p) { return p.full.processor_ms / p.ours.processor_ms; };
  const auto clock_ratio = [](const Pair& p) { return p.full.clock_ms / p.ours.clock_ms; };
  const auto town = [](const Pair& p) { return p.town.processor_ms / p.ours.processor_ms; };
  const auto people = [](const Pair& p) {
    return (p.full.processor_ms - p.town.processor_ms) / std::max(0.1, p.ours.processor_ms - p.town.processor_ms);
  };
  const auto row = [&](const char* what, auto cost) {
    std::printf("%-36s %9.1f ms processor, all threads %9.1f ms by the clock\n", what,
                MedianOf(all, [&](const Pair& p) { return cost(p).processor_ms; }),
                MedianOf(all, [&](const Pair& p) { return cost(p).clock_ms; }));
  };
  row("as decided", [](const Pair& p) { return p.ours; });
  row("everybody as finest mesh", [](const Pair& p) { return p.full; });
  row("nobody: the town", [](const Pair& p) { return p.town; });
  std::printf("%-36s %9.0f and %.0f\n", "people's triangles, ours and full",
              MedianOf(all, [](const Pair& p) { return static_cast<double>(p.our_triangles); }),
              MedianOf(all, [](const Pair& p) { return static_cast<double>(p.full_triangles); }));
  std::printf("%-36s %9.0f %% of ours\n", "the town's share", 100 * MedianOf(all, town));
  std::printf("%-36s %9.1f\n", "people alone, full to ours", MedianOf(all, people));
  std::printf("%-36s %9.1f by processor time, %.1f by the clock; runs:", "whole pictures, full to ours",
              MedianOf(all, ratio), MedianOf(all, clock_ratio));
  for (double r : ratios_of_runs) std::printf(" %.1f", r);
  std::printf("\n");
}

Error Run(int argc, char** argv) {
  if (argc < 3)
    return Fail("usage: bench_full_geometry PACK SCENARIO [PEOPLE [PICTURES [RUNS [WIDTHxHEIGHT[@SCALE]]]]]");
  Setting setting;
  if (argc > 4) setting.pictures = std::max(1, std::atoi(argv[4]));
  if (argc > 5) setting.runs = std::max(1, std::atoi(argv[5]));
  if (argc > 6) std::sscanf(argv[6], "%dx%d@%f", &setting.width_px, &setting.height_px, &setting.scale);
  TourPack pack;
  if (Error e = LoadTourPack(argv[1], {}, &pack)) return e;
  Scenario scenario = ScenarioOf(pack);
  if (Error e = ReadScenario(argv[2], &scenario)) return e;
  if (argc > 3 && std::atoi(argv[3]) > 0) scenario.crowd.people = std::atoi(argv[3]);
  scenario.screen_width_px = setting.width_px;
  HeadlessContext context;
  if (Error e = context.Create()) return e;
  Renderer renderer;
  if (Error e = renderer.Create(pack)) return e;
  std::vector<Pair> all;
  std::vector<double> ratios;
  for (int run = 0; run < setting.runs; ++run, ++scenario.crowd.seed) {
    std::vector<Pair> pairs;
    if (Error e = Play(pack, scenario, setting, &renderer, &pairs)) return e;
    ratios.push_back(MedianOf(pairs, [](const Pair& p) { return p.full.processor_ms / p.ours.processor_ms; }));
    all.insert(all.end(), pairs.begin(), pairs.end());
  }
  std::printf("%s, %d people, %d x %d pixels, scale %.1f, %zu pictures over %d walks\n", context.Renderer().c_str(),
              scenario.crowd.people, setting.width_px, setting.height_px, static_cast<double>(setting.scale),
              all.size(), setting.runs);
  Print(all, ratios);
  return Ok();
}

}  // namespace
}  // namespace flaneur

int main(int argc, char** argv) {
  const flaneur::Error error = flaneur::Run(argc, argv);
  if (!error) return 0;
  std::fprintf(stderr, "bench_full_geometry: error: %s\n", error.message.c_str());
  return 2;
}
