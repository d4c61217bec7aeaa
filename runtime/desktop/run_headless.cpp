#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

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
#include "runtime/visit/developer_views.h"

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

void DrawPane(const PlayerOptions& options, const TourPack& pack, int width_px, bool read, Renderer* renderer,
              Overlay* overlay, Pane* pane) {
  FrameFromSimulation(pack, *pane->simulation, &pane->looks, &pane->frame);
  if (!pane->label.empty()) {
    pane->frame.caption = pane->label;
    pane->frame.caption_share = 1;
  }
  renderer->Draw(pane->frame, width_px, options.height_px, &pane->statistics);
  if (overlay != nullptr) {
    overlay->Begin(width_px, options.height_px, {});
    ShowViews(pane->statistics, width_px, options.height_px, &pane->views, pane->simulation);
    overlay->Draw();
  }
  if (read) renderer->Read(&pane->rgb);
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

}  // namespace

Error RunHeadless(const PlayerOptions& options, float seconds, const TourPack& pack, Loader* loader,
                  std::vector<Simulation>* simulations) {
  WatchForInterruption();
  HeadlessContext context;
  if (Error e = context.Create()) return e;
  const bool filming = !options.film.empty();
  // Stills alone need only their own pictures drawn, and may take their time for that.
  const bool draw_all = filming || !options.metrics.empty() || options.screenshot.empty();
  RenderOptions render_options;
  if (options.samples || !draw_all) render_options.samples = options.samples.value_or(kStillSamples);
  Renderer renderer;
  if (Error e = renderer.Begin(pack, render_options)) return e;
  loader->PrepareFor(renderer);
  if (Error e = loader->UploadAll(&renderer)) return e;
  Overlay overlay;
  if (options.views) {
    if (Error e = overlay.Create()) return e;
  }
  std::vector<Pane> panes;
  for (size_t k = 0; k < simulations->size(); ++k) {
    panes.push_back(
        {&(*simulations)[k], options.compare.empty() ? "" : "adaptation: " + options.compare[k], {}, {}, {}, {}, {}});
  }
  Simulation& first = simulations->front();
  std::vector<Still> stills = StillsOf(options, Step_s(first));
  Records records;
  records.keep_metrics = !options.metrics.empty();
  records.keep_trajectories = !options.trajectories.empty();
  FilmWriter film;
  if (filming) {
    if (Error e = film.Start(options.film, options.width_px, options.height_px, 1 / Step_s(first))) return e;
  }
  const auto steps = static_cast<int64_t>(static_cast<double>(seconds) / static_cast<double>(Step_s(first)) + 0.5);
  if (!stills.empty() && stills.back().frame > steps) {
    return Fail("the run ends after " + Compact(static_cast<double>(seconds)) + " s, before " +
                stills.back().path.string() + "; --at must be earlier");
  }
  const auto over = [&](const Simulation& s) { return s.town.step >= steps || s.visitor.finished; };
  for (;;) {
    if (Error e = CheckInterruption()) return e;
    const bool last = std::all_of(simulations->begin(), simulations->end(), over);
    const bool still = !stills.empty() && (stills.front().frame == first.town.step || last);
    if (still && !draw_all) {
      renderer.StartAnew();
      for (Pane& pane : panes) pane.looks = {};
    }
    if (draw_all || still) {
      const int width_px = options.width_px / static_cast<int>(panes.size());
      for (Pane& pane : panes)
        DrawPane(options, pack, width_px, filming || still, &renderer, options.views ? &overlay : nullptr, &pane);
      if (filming) {
        if (Error e = film.Add(Joined(panes, options.height_px))) return e;
      }
    }
    if (still) {
      if (Error e = WriteDue(panes, options, first.town.step, last, &stills)) return e;
    }
    Record(first,
           {panes[0].statistics.town_triangles, panes[0].statistics.shadow_triangles, panes[0].statistics.draw_ms},
           &records);
    RememberFrame(first, panes[0].statistics, static_cast<float>(panes[0].statistics.draw_ms), &panes[0].views.history);
    if (last) break;
    for (Pane& pane : panes) {
      if (!over(*pane.simulation)) StepSimulation({}, static_cast<float>(pane.statistics.draw_ms), pane.simulation);
    }
  }
  if (filming) {
    if (Error e = film.Finish()) return e;
  }
  return WriteRecords(records, options.metrics, options.trajectories);
}

}  // namespace flaneur
