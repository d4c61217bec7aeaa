// What flaneur-player does with --headless --screenshot, as a page's code: a page writes pack and scenario into the
// program's memory as files, calls draw_still and reads the picture.
#include <emscripten/emscripten.h>
#include <emscripten/html5.h>

#include <string>

#include "runtime/base/png.h"
#include "runtime/render/renderer.h"
#include "runtime/show/frame_from_simulation.h"
#include "runtime/show/guide_figure.h"
#include "runtime/simulation/simulation.h"
#include "runtime/visit/loading.h"

namespace flaneur {
namespace {

constexpr int kSamples = 4;

Error MakeContext() {
  EmscriptenWebGLContextAttributes wished;
  emscripten_webgl_init_context_attributes(&wished);
  wished.majorVersion = 2;
  wished.alpha = wished.antialias = wished.stencil = wished.depth = false;
  const auto context = emscripten_webgl_create_context("#picture", &wished);
  if (context > 0 && emscripten_webgl_make_context_current(context) == EMSCRIPTEN_RESULT_SUCCESS) return Ok();
  return Fail("this browser does not offer WebGL 2");
}

void Walk(const Scenario& scenario, Simulation* simulation) {
  const auto steps = static_cast<int64_t>(scenario.seconds.value_or(0) / Step_s(*simulation) + 0.5f);
  while (simulation->town.step < steps && !simulation->visitor.finished)
    StepSimulation({}, FrameTimeByModel_ms(*simulation), simulation);
}

Error DrawStill(int width_px, int height_px) {
  PackFile file;
  TourPack pack;
  if (Error e = file.Open("pack.glb", &pack)) return e;
  AddGuideFigure(&pack);
  Scenario scenario = ScenarioOf(pack);
  if (Error e = ReadScenario("scenario.toml", &scenario)) return e;
  scenario.screen_width_px = width_px;
  scenario.screen_height_px = height_px;
  Loader loader;
  loader.Start(std::move(file), pack);
  Simulation simulation;
  if (Error e = StartSimulation(&pack, scenario, &simulation)) return e;
  Walk(scenario, &simulation);
  if (Error e = MakeContext()) return e;
  Renderer renderer;
  RenderOptions options;
  options.averages = true;
  options.samples = kSamples;
  if (Error e = renderer.Begin(pack, options)) return e;
  loader.PrepareFor(renderer);
  if (Error e = loader.UploadAll(&renderer)) return e;
  PersonLooks looks;
  FrameInput frame;
  FrameStatistics statistics;
  std::vector<uint8_t> rgb;
  FrameFromSimulation(pack, simulation, &looks, &frame);
  renderer.Draw(frame, width_px, height_px, &statistics);
  renderer.Read(&rgb);
  return WritePng("still.png", width_px, height_px, rgb);
}

}  // namespace
}  // namespace flaneur

// Returns what is wrong, or an empty text. The picture is in still.png.
extern "C" EMSCRIPTEN_KEEPALIVE const char* draw_still(int width_px, int height_px) {
  static std::string said;
  try {
    said = flaneur::DrawStill(width_px, height_px).message;
  } catch (const std::exception& e) {
    said = e.what();
  }
  return said.c_str();
}
