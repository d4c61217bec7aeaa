#include <algorithm>
#include <cstring>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/base/jobs.h"
#include "runtime/base/png.h"
#include "runtime/base/text.h"
#include "runtime/desktop/context.h"
#include "runtime/desktop/film.h"
#include "runtime/desktop/interruption.h"
#include "runtime/desktop/run.h"
#include "runtime/desktop/stills.h"
#include "runtime/render/overlay.h"
#include "runtime/render/renderer.h"
#include "runtime/show/frame_from_simulation.h"
#include "runtime/simulation/records.h"
#include "runtime/simulation/side_by_side.h"
#include "runtime/text/system_fonts.h"
#include "runtime/visit/developer_views.h"
#include "runtime/visit/page_look.h"

namespace flaneur {
namespace {

constexpr int kStillSamples = 4;
constexpr size_t kDivider_px = 2;

// One simulation's part of the picture, as wide as every other's.
struct Pane {
  Simulation* simulation;
  std::string label;  // instead of the tour's captions; empty: those
  PersonLooks looks;
  FrameInput frame;
  FrameStatistics statistics;
  std::vector<uint8_t> rgb;
  DeveloperViews views;
};

// loader: of what the picture needs and is not there yet; null: all is there.
Error DrawPane(const PlayerOptions& options, const TourPack& pack, int width_px, bool read, Loader* loader,
               Renderer* renderer, Overlay* overlay, Pane* pane) {
  FrameFromSimulation(pack, *pane->simulation, &pane->looks, &pane->frame);
  if (!pane->label.empty()) {
    pane->frame.caption = pane->label;
    pane->frame.caption_share = 1;
  }
  if (loader != nullptr) {
    const std::vector<AssetId> needed = renderer->AssetsFor(pane->frame, width_px, options.height_px);
    if (Error e = loader->UploadThese(needed, renderer)) return e;
  }
  renderer->Draw(pane->frame, width_px, options.height_px, &pane->statistics);
  if (overlay != nullptr) {
    overlay->Begin(width_px, options.height_px, {});
    ShowViews(pane->statistics, width_px, options.height_px, &pane->views, pane->simulation);
    overlay->Draw();
  }
  if (read) renderer->Read(&pane->rgb);
  return Ok();
}

// Side by side, a white line between them.
std::vector<uint8_t> Joined(const std::vector<Pane>& panes, int height_px) {
  if (panes.size() == 1) return panes[0].rgb;
  const size_t rows = static_cast<size_t>(height_px), row = panes[0].rgb.size() / rows;
  std::vector<uint8_t> rgb(panes.size() * panes[0].rgb.size());
  for (size_t y = 0; y < rows; ++y) {
    for (size_t k = 0; k < panes.size(); ++k) {
      uint8_t* to = &rgb[(y * panes.size() + k) * row];
      std::memcpy(to, &panes[k].rgb[y * row], row);
      if (k > 0) std::memset(to, 255, kDivider_px * 3);
    }
  }
  return rgb;
}

// Writes those that are due; `ended`: this is the last picture.
Error WriteDue(const std::vector<Pane>& panes, const PlayerOptions& options, int64_t frame, bool ended,
               std::vector<Still>* stills) {
  while (!stills->empty() && (stills->front().frame == frame || (ended && stills->front().frame < 0))) {
    if (Error e = WritePng(stills->front().path, options.width_px, options.height_px, Joined(panes, options.height_px)))
      return e;
    stills->erase(stills->begin());
  }
  if (!ended || stills->empty()) return Ok();
  const double ends_s = static_cast<double>(frame) * static_cast<double>(Step_s(*panes[0].simulation));
  return Fail("the walk ends after " + Compact(ends_s) + " s, before " + stills->front().path.string() +
              "; --at must be earlier");
}

// All that a run without a window draws with and writes into.
struct HeadlessRun {
  const PlayerOptions& options;
  StartingTour& tour;
  bool films, draws_all;
  int64_t steps = 0;
  HeadlessContext context{};
  Fonts fonts{SystemFonts()};
  Renderer renderer{};
  Overlay overlay{&fonts};
  std::vector<Pane> panes{};    // a simulation each
  std::vector<Still> stills{};  // that have still to be written
  FilmWriter film{};
  Records records{};
};

bool IsOver(const Simulation& s, const HeadlessRun& run) { return s.town.step >= run.steps || s.visitor.finished; }

// The town and all pictures, or whatever there is.
Error PrepareDrawing(HeadlessRun* run) {
  RenderOptions options;
  options.averages = true;
  options.fonts = &run->fonts;
  if (run->options.samples || !run->draws_all) options.samples = run->options.samples.value_or(kStillSamples);
  if (Error e = run->renderer.Begin(run->tour.pack, options)) return e;
  if (run->options.views) {
    if (Error e = run->overlay.Create()) return e;
  }
  Loader& loader = run->tour.loader;
  loader.PrepareFor(run->renderer);
  return run->draws_all ? loader.UploadAll(&run->renderer) : loader.UploadThese({}, &run->renderer);
}

// One beside the other, as nearly all the time until a first still goes into them. What is wrong with the tour comes
// first.
Error Beside(Jobs* jobs, const std::function<Error()>& of_tour, const std::function<Error()>& here) {
  Error wrong_tour;
  Job job = StartJob(jobs, [&] { return wrong_tour = of_tour(), true; });
  Error wrong_here = here();
  job.Wait();
  return wrong_tour ? wrong_tour : wrong_here;
}

Error Prepare(HeadlessRun* run) {
  StartingTour* tour = &run->tour;
  const auto open = [&] { return OpenTour(run->options, tour); };
  if (Error e = Beside(&tour->jobs, open, [&] { return run->context.Create(); })) return e;
  tour->loader.Start(std::move(tour->file), tour->pack);
  const auto start = [&] { return StartSimulations(run->options, tour); };
  if (Error e = Beside(&tour->jobs, start, [&] { return PrepareDrawing(run); })) return e;
  WarnOfTour(*tour);
  return Ok();
}

Error PrepareOutputs(HeadlessRun* run) {
  const PlayerOptions& options = run->options;
  std::vector<Simulation>& simulations = run->tour.simulations;
  const float seconds = RunLength_s(options, run->tour.scenario, simulations.front());
  const float step_s = Step_s(simulations.front());
  for (size_t k = 0; k < simulations.size(); ++k) {
    const std::string label = options.compare.empty() ? "" : "adaptation: " + options.compare[k];
    run->panes.push_back({&simulations[k], label, {}, {}, {}, {}, {}});
  }
  run->records.keep_metrics = !options.metrics.empty();
  run->records.keep_trajectories = !options.trajectories.empty();
  if (run->films) {
    if (Error e = run->film.Start(options.film, options.width_px, options.height_px, 1 / step_s)) return e;
  }
  run->steps = static_cast<int64_t>(static_cast<double>(seconds) / static_cast<double>(step_s) + 0.5);
  run->stills = StillsOf(options, step_s);
  if (run->stills.empty() || run->stills.back().frame <= run->steps) return Ok();
  return Fail("the run ends after " + Compact(static_cast<double>(seconds)) + " s, before " +
              run->stills.back().path.string() + "; --at must be earlier");
}

bool IsStillDue(bool last, const HeadlessRun& run) {
  return !run.stills.empty() && (run.stills.front().frame == run.tour.simulations.front().town.step || last);
}

// The picture of this step, where one is asked for. last: the run ends with it.
Error MakePicture(bool last, HeadlessRun* run) {
  const PlayerOptions& options = run->options;
  const bool still = IsStillDue(last, *run);
  if (!still && !run->draws_all) return Ok();
  if (!run->draws_all) {
    run->renderer.StartAnew();
    for (Pane& pane : run->panes) pane.looks = {};
  }
  const int width_px = options.width_px / static_cast<int>(run->panes.size());
  Overlay* overlay = options.views ? &run->overlay : nullptr;
  for (Pane& pane : run->panes) {
    Loader* loader = run->draws_all ? nullptr : &run->tour.loader;
    if (Error e =
            DrawPane(options, run->tour.pack, width_px, run->films || still, loader, &run->renderer, overlay, &pane))
      return e;
  }
  return Ok();
}

void RecordStep(HeadlessRun* run) {
  const Simulation& first = run->tour.simulations.front();
  Pane& pane = run->panes.front();
  const FrameStatistics& drawn = pane.statistics;
  Record(first, {drawn.town_triangles, drawn.shadow_triangles, drawn.draw_ms}, &run->records);
  RememberFrame(first, drawn, static_cast<float>(drawn.draw_ms), &pane.views.history);
}

// Into the film, the stills and the records.
Error KeepPicture(bool last, HeadlessRun* run) {
  if (run->films) {
    if (Error e = run->film.Add(Joined(run->panes, run->options.height_px))) return e;
  }
  RecordStep(run);
  return IsStillDue(last, *run)
             ? WriteDue(run->panes, run->options, run->tour.simulations.front().town.step, last, &run->stills)
             : Ok();
}

void StepAll(HeadlessRun* run) {
  std::vector<Simulation*> runs;
  std::vector<float> frame_ms;
  for (Pane& pane : run->panes) {
    if (IsOver(*pane.simulation, *run)) continue;
    runs.push_back(pane.simulation);
    frame_ms.push_back(static_cast<float>(pane.statistics.draw_ms));
  }
  StepSideBySide(runs, frame_ms);
}

}  // namespace

Error RunHeadless(const PlayerOptions& options, const PlayerSettings& settings, StartingTour* tour) {
  WatchForInterruption();
  // Stills alone need only their own pictures drawn, and may take their time for that.
  const bool films = !options.film.empty();
  const bool draws_all = films || !options.metrics.empty() || options.screenshot.empty();
  HeadlessRun run{options, *tour, films, draws_all};
  if (Error e = Prepare(&run)) return e;
  if (Error e = PrepareOutputs(&run)) return e;
  for (Pane& pane : run.panes) {
    CameraState& camera = pane.simulation->visitor.camera;
    camera.eye_height_m = EyeHeight_m(settings, camera.eye_height_m);
    pane.frame.caption_style = CaptionStyleOf(settings, pane.simulation->visitor.tour.language);
  }
  for (bool last = false; !last;) {
    if (Error e = CheckInterruption()) return e;
    last = std::all_of(tour->simulations.begin(), tour->simulations.end(),
                       [&](const Simulation& s) { return IsOver(s, run); });
    if (Error e = MakePicture(last, &run)) return e;
    if (last) {
      if (Error e = EndWatching()) return e;
    }
    if (Error e = KeepPicture(last, &run)) return e;
    if (!last) StepAll(&run);
  }
  if (films) {
    if (Error e = run.film.Finish()) return e;
  }
  return WriteRecords(run.records, options.metrics, options.trajectories);
}

}  // namespace flaneur
