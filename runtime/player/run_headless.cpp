#include <cstdio>

#include "runtime/player/film.h"
#include "runtime/player/frame_from_simulation.h"
#include "runtime/player/interruption.h"
#include "runtime/player/records.h"
#include "runtime/player/run.h"
#include "runtime/render/context.h"
#include "runtime/render/renderer.h"

namespace flaneur {
namespace {

constexpr int kStillSamples = 4;

}  // namespace

Error RunHeadless(const PlayerOptions& options, float seconds, const TourPack& pack, Simulation* simulation) {
  WatchForInterruption();
  HeadlessContext context;
  if (Error e = context.Create()) return e;
  const bool filming = !options.film.empty();
  // A still alone needs only its last picture drawn, and may take its time for that.
  const bool draw_all = filming || !options.metrics.empty() || options.screenshot.empty();
  RenderOptions render_options;
  if (!draw_all) render_options.samples = kStillSamples;
  Renderer renderer;
  if (Error e = renderer.Create(pack, render_options)) return e;
  Records records;
  records.keep_metrics = !options.metrics.empty();
  records.keep_trajectories = !options.trajectories.empty();
  FilmWriter film;
  if (filming) {
    if (Error e = film.Start(options.film, options.width_px, options.height_px, 1 / simulation->step_s)) return e;
  }
  const auto steps = static_cast<int64_t>(static_cast<double>(seconds) / static_cast<double>(simulation->step_s) + 0.5);
  PersonLooks looks;
  FrameInput frame;
  FrameStatistics statistics;
  std::vector<uint8_t> rgb;
  for (;;) {
    if (Error e = CheckInterruption()) return e;
    const bool last = simulation->frame >= steps || simulation->finished;
    if (draw_all || last) {
      FrameFromSimulation(pack, *simulation, &looks, &frame);
      renderer.Draw(frame, options.width_px, options.height_px, &statistics);
      if (filming || last) renderer.Read(&rgb);
      if (filming) {
        if (Error e = film.Add(rgb)) return e;
      }
    }
    Record(*simulation, {statistics.town_triangles, statistics.draw_ms}, &records);
    if (last) break;
    StepSimulation({}, static_cast<float>(statistics.draw_ms), simulation);
  }
  if (!options.screenshot.empty()) {
    if (Error e = WritePng(options.screenshot, options.width_px, options.height_px, rgb)) return e;
  }
  if (filming) {
    if (Error e = film.Finish()) return e;
  }
  return WriteRecords(records, options.metrics, options.trajectories);
}

}  // namespace flaneur
