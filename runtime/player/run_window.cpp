#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "runtime/player/frame_from_simulation.h"
#include "runtime/player/records.h"
#include "runtime/player/run.h"
#include "runtime/player/views.h"
#include "runtime/render/context.h"
#include "runtime/render/overlay.h"
#include "runtime/render/renderer.h"

namespace flaneur {
namespace {

constexpr float kWalkSpeed_mps = 1.5f;
constexpr double kLongUpload_ms = 50, kUpload_ms = 3;  // of what has been loaded: before the first picture, and in each later one
constexpr float kMostPitch_rad = 1.2f;
constexpr int kMostStepsAFrame = 4;  // a machine that can't keep up slows the town down rather than freeze

double Now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

CameraInput ToCameraInput(const WindowInput& input, bool free_walk, const Simulation& s) {
  CameraInput out;
  out.active = free_walk;
  const float yaw = s.camera.view.yaw_rad;
  const Vec2 ahead{std::cos(yaw), std::sin(yaw)}, right{ahead.y, -ahead.x};
  const Vec2 way = ahead * input.walk.y + right * input.walk.x;
  const float length = Length(way);
  if (length > 0) out.direction = way * (1 / length);
  out.speed_mps = length > 0 ? kWalkSpeed_mps : 0;
  out.yaw_rate_radps = input.turn_rad / s.step_s;
  return out;
}

}  // namespace

Error RunInWindow(const PlayerOptions& options, const TourPack& pack, Loader* loader, Simulation* s) {
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
  bool free_walk = s->legs.empty() && s->tour.stops.empty();
  double clock_s = Now_s(), owed_s = 0, title_s = clock_s;
  int frames = 0;
  PersonLooks looks;
  FrameInput frame;
  FrameStatistics statistics;
  for (;;) {
    if (Error e = loader->Upload(kUpload_ms, &renderer)) return e;
    WindowInput input = window.Poll();
    if (window.WasPressed("f1")) views.shown = !views.shown;
    if (window.WasPressed("f2")) SwitchAdaptation(s);
    if (input.close || (options.seconds && static_cast<float>(s->frame) * s->step_s >= *options.seconds)) break;
    if (input.toggle_tour || input.walk.x != 0 || input.walk.y != 0) free_walk = input.toggle_tour ? !free_walk : true;
    s->camera.pitch_rad = std::clamp(s->camera.pitch_rad + input.pitch_rad, -kMostPitch_rad, kMostPitch_rad);
    const double now_s = Now_s(), frame_s = now_s - clock_s;
    clock_s = now_s;
    owed_s = std::min(owed_s + frame_s, static_cast<double>(s->step_s) * kMostStepsAFrame);
    while (owed_s >= static_cast<double>(s->step_s)) {
      StepSimulation(ToCameraInput(input, free_walk, *s), static_cast<float>(frame_s * 1000), s);
      Record(*s, {statistics.town_triangles, statistics.draw_ms}, &records);
      input.turn_rad = 0;  // a mouse movement turns once
      owed_s -= static_cast<double>(s->step_s);
    }
    int width_px = 0, height_px = 0;
    window.Size(&width_px, &height_px);
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
      char title[160];
      std::snprintf(title, sizeof title, "%s - %.0f frames/s, %zu people, %lld triangles", pack.name.c_str(),
                    frames / (now_s - title_s), s->crowd.size(),
                    static_cast<long long>(statistics.people_triangles + statistics.town_triangles));
      window.SetTitle(title);
      title_s = now_s;
      frames = 0;
    }
  }
  return WriteRecords(records, options.metrics, options.trajectories);
}

}  // namespace flaneur
