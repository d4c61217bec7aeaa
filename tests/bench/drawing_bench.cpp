// What a picture costs: bench_drawing PACK SCENARIO [PEOPLE [FRAMES [WIDTHxHEIGHT[@SCALE|@rule] [whole|passes
// [PICTURE]]]]]
//
// Plays the scenario and draws its frames. Prints medians and 99th percentiles. Processor times are those of all
// threads: on a machine that does other work as well they say more than the clock. SCALE: FrameInput::resolution_scale,
// or `rule`: from picture to picture what the window would choose, with the settings' defaults. With `passes` what each
// pass takes. PICTURE: the last of them, as PNG. What levels of detail save: bench_full_geometry.
#include <time.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "runtime/base/png.h"
#include "runtime/desktop/context.h"
#include "runtime/render/people_batches.h"
#include "runtime/render/renderer.h"
#include "runtime/show/frame_from_simulation.h"
#include "runtime/simulation/scenario.h"
#include "runtime/simulation/simulation.h"
#include "runtime/visit/player_settings.h"
#include "runtime/visit/resolution.h"

namespace flaneur {
namespace {

constexpr int kWarm = 3;                                 // frames before the first that counts
constexpr float kMoves_mps = 0.3f, kTurns_radps = 0.2f;  // as the window sees it

double Clock_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
double Processor_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

struct Series {
  std::vector<double> values;
  double At(double share) const {
    if (values.empty()) return 0;
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    return sorted[std::min(sorted.size() - 1, static_cast<size_t>(share * static_cast<double>(sorted.size())))];
  }
};

void Print(const char* what, const Series& s, const char* unit) {
  std::printf("%-44s %9.2f %9.2f %9.2f  %s\n", what, s.At(0), s.At(0.5), s.At(0.99), unit);
}

struct Costs {
  Series clock_ms, processor_ms, town_triangles, people_triangles, shadow_triangles, people_shadow_triangles, calls,
      drawn, hidden, people_ms;
  std::array<Series, std::size(kDrawPassNames)> pass_ms;
};

void Draw(const FrameInput& frame, int width_px, int height_px, Renderer* renderer, Costs* costs) {
  FrameStatistics s;
  const double clock = Clock_ms(), processor = Processor_ms();
  renderer->Draw(frame, width_px, height_px, &s);
  costs->processor_ms.values.push_back(Processor_ms() - processor);
  costs->clock_ms.values.push_back(Clock_ms() - clock);
  costs->town_triangles.values.push_back(static_cast<double>(s.town_triangles));
  costs->people_triangles.values.push_back(static_cast<double>(s.people_triangles));
  costs->shadow_triangles.values.push_back(static_cast<double>(s.shadow_triangles));
  costs->people_shadow_triangles.values.push_back(static_cast<double>(s.people_shadow_triangles));
  costs->calls.values.push_back(s.draw_calls);
  costs->drawn.values.push_back(s.people_drawn);
  costs->hidden.values.push_back(s.people_hidden);
  costs->people_ms.values.push_back(s.people_ms);
  for (size_t k = 0; k < costs->pass_ms.size(); ++k) costs->pass_ms[k].values.push_back(s.pass_ms[k]);
}

// The window's rule, from picture to picture.
struct Rule {
  bool on = false;
  ResolutionSettings wished;
  Resolution resolution;
  void Apply(FrameInput* frame) const {
    if (!on) return;
    frame->resolution_scale = ScaleNow(wished, resolution);
    frame->detail = DetailNow(wished, resolution);
  }
  void Follow(double took_ms, const CameraState& camera) {
    const bool moves = camera.actual_mps > kMoves_mps || std::abs(camera.yaw_rate_radps) > kTurns_radps;
    if (on) FollowPictureTime(static_cast<float>(took_ms), moves, wished, &resolution);
  }
};

Error Run(int argc, char** argv) {
  if (argc < 3)
    return Fail(
        "usage: bench_drawing PACK SCENARIO [PEOPLE [FRAMES [WIDTHxHEIGHT[@SCALE|@rule] [whole|passes [PICTURE]]]]]");
  int width_px = 1280, height_px = 720;
  float scale = 1;
  if (argc > 5) std::sscanf(argv[5], "%dx%d@%f", &width_px, &height_px, &scale);
  const bool by_rule = argc > 5 && std::string(argv[5]).ends_with("@rule");
  const bool passes = argc > 6 && std::string(argv[6]) == "passes";
  const int frames = argc > 4 ? std::atoi(argv[4]) : 60;
  TourPack pack;
  if (Error e = LoadTourPack(argv[1], {}, &pack)) return e;
  Scenario scenario = ScenarioOf(pack);
  if (Error e = ReadScenario(argv[2], &scenario)) return e;
  if (argc > 3 && std::atoi(argv[3]) > 0) scenario.crowd.people = std::atoi(argv[3]);
  Simulation s;
  if (Error e = StartSimulation(&pack, scenario, &s)) return e;
  HeadlessContext context;
  if (Error e = context.Create()) return e;
  Renderer renderer;
  if (Error e = renderer.Create(pack, {.time_passes = passes})) return e;

  size_t clip_bytes = 0;
  for (const PackAvatar& avatar : pack.avatars) clip_bytes = std::max(clip_bytes, ClipBytes(LayoutOf(avatar)));
  Costs as_decided;
  Series scales, details, people_ms, levels_ms, all_looks_ms, known_shadow_triangles;
  PersonLooks looks;
  FrameInput frame;
  FrameFromSimulation(pack, s, &looks, &frame);
  const PlayerSettings settings;
  const ResolutionSettings wished =
      ResolutionFor(settings.frames_per_s, settings.least_resolution_scale, s.control.settings);
  Rule rule{by_rule, wished, FirstResolution(wished, renderer.software())};
  for (int k = 0; k < frames + kWarm && !s.visitor.finished; ++k) {
    const double before = Clock_ms();
    FrameFromSimulation(pack, s, &looks, &frame);
    frame.resolution_scale = scale;
    rule.Apply(&frame);
    scales.values.push_back(100 * static_cast<double>(frame.resolution_scale));
    details.values.push_back(100 * static_cast<double>(frame.detail));
    const double looks_ms = Clock_ms() - before;
    Costs unused;
    Costs* costs = k < kWarm ? &unused : &as_decided;
    Draw(frame, width_px, height_px, &renderer, costs);
    rule.Follow(costs->clock_ms.values.back(), s.visitor.camera);
    levels_ms.values.push_back(s.control_ms);
    known_shadow_triangles.values.push_back(static_cast<double>(s.control.levels.shadows.triangles));
    all_looks_ms.values.push_back(looks_ms);
    people_ms.values.push_back(s.control_ms + looks_ms + costs->people_ms.values.back());
    StepSimulation({}, 0, &s);
  }
  if (argc > 7) {
    std::vector<uint8_t> rgb;
    renderer.Read(&rgb);
    if (Error e = WritePng(argv[7], width_px, height_px, rgb)) return e;
  }
  std::printf("%s, %zu people, %d x %d pixels\n%-44s %9s %9s %9s\n", context.Renderer().c_str(), s.town.crowd.size(),
              width_px, height_px, "", "least", "median", "99th perc.");
  Print("frame time, clock", as_decided.clock_ms, "ms");
  Print("frame time, processor, all threads", as_decided.processor_ms, "ms");
  for (size_t k = 0; k < std::size(kDrawPassNames) && passes; ++k) {
    Print((std::string("  ") + kDrawPassNames[k]).c_str(), as_decided.pass_ms[k], "ms");
  }
  Print("resolution scale", scales, "% of width and height");
  Print("detail of people", details, "% of that");
  Print("town", as_decided.town_triangles, "triangles");
  Print("people", as_decided.people_triangles, "triangles");
  Print("shadows", as_decided.shadow_triangles, "triangles");
  Print("  of them people's", as_decided.people_shadow_triangles, "triangles");
  Print("  as the budget counts them", known_shadow_triangles, "triangles");
  Print("drawn people, both levels of who changes", as_decided.drawn, "");
  Print("hidden people", as_decided.hidden, "");
  Print("draw calls", as_decided.calls, "");
  Print("people on the CPU: levels, looks, cull, upload", people_ms, "ms");
  Print("  of it levels", levels_ms, "ms");
  Print("  of it looks", all_looks_ms, "ms");
  Print("  of it cull, sort, poses, upload", as_decided.people_ms, "ms");
  std::printf("99th percentile over median: %.2f by the clock, %.2f by processor time\n",
              as_decided.clock_ms.At(0.99) / as_decided.clock_ms.At(0.5),
              as_decided.processor_ms.At(0.99) / as_decided.processor_ms.At(0.5));
  std::printf("animation memory, the largest of all avatars: %.0f KB\n", static_cast<double>(clip_bytes) / 1024);
  return Ok();
}

}  // namespace
}  // namespace flaneur

int main(int argc, char** argv) {
  const flaneur::Error error = flaneur::Run(argc, argv);
  if (!error) return 0;
  std::fprintf(stderr, "bench_drawing: error: %s\n", error.message.c_str());
  return 2;
}
