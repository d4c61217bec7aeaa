#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

#include "runtime/base/clock.h"
#include "runtime/player/frame_from_simulation.h"
#include "runtime/player/records.h"
#include "runtime/player/run.h"
#include "runtime/player/speaker.h"
#include "runtime/player/views.h"
#include "runtime/render/context.h"
#include "runtime/render/overlay.h"
#include "runtime/render/renderer.h"

namespace flaneur {
namespace {

constexpr double kLongUpload_ms = 50, kUpload_ms = 3;  // of what has been loaded: before the first picture, and in each later one
constexpr int kMostStepsAFrame = 4;  // a machine that can't keep up slows the town down rather than freeze

// What the settings ask of the simulation, now and whenever they change.
void ApplySettings(const PlayerSettings& settings, float own_fov_rad, Simulation* s) {
  s->gentle = settings.reduced_motion;
  SetFieldOfView(settings.field_of_view_deg > 0 ? settings.field_of_view_deg * kPi / 180 : own_fov_rad, s);
  const std::vector<std::string>& known = s->tour.languages;
  const bool spoken = std::find(known.begin(), known.end(), settings.language) != known.end();
  if (spoken && settings.language != s->tour.language) SetLanguage(settings.language, &s->tour);
}

std::string Title(const std::string& name, double frames_per_s, const Simulation& s, const FrameStatistics& statistics) {
  char title[200];
  std::snprintf(title, sizeof title, "%s%s - %.0f frames/s, %zu people, %lld triangles", name.c_str(),
                s.tour.paused && HasTour(s.tour) ? " - tour paused" : "", frames_per_s, s.crowd.size(),
                static_cast<long long>(statistics.people_triangles + statistics.town_triangles));
  return title;
}

}  // namespace

Error RunInWindow(const PlayerOptions& options, const TourPack& pack, Loader* loader, Controls* controls, Simulation* s) {
  Window window;
  if (Error e = window.Create(options.width_px, options.height_px, pack.name.c_str())) return e;
  Renderer renderer;
  if (Error e = renderer.Begin(pack)) return e;
  loader->PrepareFor(renderer);
  while (!loader->TownIsThere()) {
    if (Error e = loader->Upload(kLongUpload_ms, &renderer)) return e;
    if (window.Poll().close) return Ok();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  Overlay overlay;
  if (Error e = overlay.Create()) return e;
  Views views;
  views.shown = options.views;
  Records records;
  records.keep_metrics = !options.metrics.empty();
  records.keep_trajectories = !options.trajectories.empty();
  const float own_fov_rad = s->camera.view.fov_rad;
  ApplySettings(controls->settings, own_fov_rad, s);
  double clock_s = Now_s(), owed_s = 0, title_s = clock_s;
  int frames = 0;
  PersonLooks looks;
  FrameInput frame;
  CameraInput wishes;
  FrameStatistics statistics;
  Speaker speaker;
  Narration narration;
  for (;;) {
    if (Error e = loader->Upload(kUpload_ms, &renderer)) return e;
    const WindowInput input = window.Poll();
    if (options.seconds && static_cast<float>(s->frame) * s->step_s >= *options.seconds) break;
    const double now_s = Now_s(), frame_s = now_s - clock_s;
    clock_s = now_s;
    int width_px = 0, height_px = 0;
    window.Size(&width_px, &height_px);
    const float aspect = static_cast<float>(std::max(1, width_px)) / static_cast<float>(std::max(1, height_px));
    TakeInput(input, static_cast<float>(frame_s), aspect, *s, controls, &wishes);
    if (controls->quits) break;
    if (controls->toggles_views) views.shown = !views.shown;
    if (controls->switches_adaptation) SwitchAdaptation(s);
    controls->toggles_views = controls->switches_adaptation = false;
    window.FreePointer(controls->points);
    if (controls->applies) ApplySettings(controls->settings, own_fov_rad, s);
    controls->applies = false;
    owed_s = std::min(owed_s + frame_s, static_cast<double>(s->step_s) * kMostStepsAFrame);
    while (owed_s >= static_cast<double>(s->step_s)) {
      StepSimulation(NextStep(wishes, *s, controls), static_cast<float>(frame_s * 1000), s);
      Record(*s, {statistics.town_triangles, statistics.draw_ms}, &records);
      wishes.tour = {};
      wishes.walk_to.reset();
      owed_s -= static_cast<double>(s->step_s);
    }
    Narrate(s->tour, pack.sounds, &narration, &speaker);
    if (width_px > 0 && height_px > 0) {
      FrameFromSimulation(pack, *s, &looks, &frame);
      renderer.Draw(frame, width_px, height_px, &statistics);
      if (views.shown) {
        overlay.Begin(width_px, height_px, {{-1, -1}, false, static_cast<float>(frame_s)});
        ShowViews(statistics, width_px, height_px, &views, s);
        overlay.Draw();
      }
      renderer.Present();
      RememberFrame(*s, statistics, static_cast<float>(frame_s * 1000), &views.history);
    }
    window.Show();
    ++frames;
    if (now_s - title_s > 1) {
      window.SetTitle(Title(pack.name, frames / (now_s - title_s), *s, statistics).c_str());
      title_s = now_s;
      frames = 0;
    }
  }
  return WriteRecords(records, options.metrics, options.trajectories);
}

}  // namespace flaneur
