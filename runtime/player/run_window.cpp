#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

#include "runtime/base/clock.h"
#include "runtime/player/controls.h"
#include "runtime/player/frame_from_simulation.h"
#include "runtime/player/menu.h"
#include "runtime/player/notices.h"
#include "runtime/player/records.h"
#include "runtime/player/run.h"
#include "runtime/player/speaker.h"
#include "runtime/player/views.h"
#include "runtime/player/warn.h"
#include "runtime/render/context.h"
#include "runtime/render/overlay.h"
#include "runtime/render/renderer.h"

namespace flaneur {
namespace {

constexpr double kLongUpload_ms = 50, kUpload_ms = 3;  // of what has been loaded: before the first picture, and in each later one
constexpr int kMostStepsAFrame = 4;  // a machine that can't keep up slows the town down rather than freeze
constexpr float kNobodyThere_s = 90;  // without a key, a click or a move, in an exhibition

std::string Title(const std::string& name, double frames_per_s, const Simulation& s, const FrameStatistics& statistics) {
  char title[200];
  std::snprintf(title, sizeof title, "%s%s - %.0f frames/s, %zu people, %lld triangles", name.c_str(),
                s.tour.paused && HasTour(s.tour) ? " - tour paused" : "", frames_per_s, s.crowd.size(),
                static_cast<long long>(statistics.people_triangles + statistics.town_triangles));
  return title;
}

// One visit: the window and all that lives as long as it does.
struct Visit {
  const PlayerOptions& options;
  const TourPack& pack;
  Loader* loader;
  UserSettings* user;
  Simulation* s;
  Window window{};
  Renderer renderer{};
  Overlay overlay{};
  Speaker speaker{};
  Controls controls{};
  Views views{};
  Menu menu{};
  Notices notices{};
  Records records{};
  PersonLooks looks{};
  FrameInput frame{};
  CameraInput wishes{};
  FrameStatistics statistics{};
  Narration narration{};
  float own_fov_rad = 0;
  double owed_s = 0;           // of simulated time
  float unused_s = 0;          // since the visitor's hands did anything
  int width_px = 0, height_px = 0;
  bool for_pages = false;      // what the hands do in this picture, even where that closes them

  bool pages() const { return menu.page != Page::kNone; }
  bool IsMinimized() const { return width_px <= 0 || height_px <= 0; }

  // False in `goes_on`: the window was closed meanwhile.
  Error Open(bool* goes_on);
  void ApplySettings();
  void Save();
  void BeginAnew();
  void TakeHands(const WindowInput& input, float passed_s);
  void ShowPages(const WindowInput& input, float passed_s);
  void StepTown(float passed_s);
  void Draw(float passed_s);
  Error Play();
};

Error Visit::Open(bool* goes_on) {
  if (Error e = window.Create(options.width_px, options.height_px, pack.name.c_str())) return e;
  if (Error e = renderer.Begin(pack)) return e;
  loader->PrepareFor(renderer);
  while (!loader->TownIsThere()) {
    if (Error e = loader->Upload(kLongUpload_ms, &renderer)) return e;
    if (window.Poll().close) {
      *goes_on = false;
      return Ok();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  if (Error e = overlay.Create()) return e;
  views.shown = options.views;
  records.keep_metrics = !options.metrics.empty();
  records.keep_trajectories = !options.trajectories.empty();
  own_fov_rad = s->camera.view.fov_rad;
  controls = MakeControls(user->settings, *s);
  ApplySettings();
  BeginHint(controls, *s, &notices);
  if (user->settings.kiosk) OpenPage(Page::kMain, &menu);
  *goes_on = true;
  return Ok();
}

// What the settings ask for, now and whenever they change.
void Visit::ApplySettings() {
  const PlayerSettings& settings = controls.settings;
  s->gentle = settings.reduced_motion;
  SetFieldOfView(settings.field_of_view_deg > 0 ? settings.field_of_view_deg * kPi / 180 : own_fov_rad, s);
  speaker.SetVolume(settings.sound_volume);
  const std::vector<std::string>& known = s->tour.languages;
  const bool spoken = std::find(known.begin(), known.end(), settings.language) != known.end();
  const std::string& language = spoken ? settings.language : known.empty() ? s->tour.language : known.front();
  if (language != s->tour.language) SetLanguage(language, &s->tour);
}

void Visit::Save() {
  if (!controls.changed) return;
  controls.changed = false;
  if (user->settings.kiosk) return;  // the next visitor finds everything as it was
  if (Error e = SaveChanges(controls.settings, user)) Warn(e.message);
}

// For the next visitor of an exhibition.
void Visit::BeginAnew() {
  controls = MakeControls(user->settings, *s);
  window.FreePointer(true);
  ApplySettings();
  JumpToStop(0, s);
  looks = {};
  OpenPage(Page::kMain, &menu);
}

void Visit::TakeHands(const WindowInput& input, float passed_s) {
  const bool used = input.down.any() || input.pressed || Length(input.turned_px) > 0 || Length(input.left_stick) > 0.3f;
  unused_s = used || (controls.follows_tour && HasTour(s->tour) && !pages()) ? 0 : unused_s + passed_s;
  if (user->settings.kiosk && unused_s > kNobodyThere_s && !pages()) BeginAnew();
  WindowInput walking = input;
  if (for_pages) walking = {input.down, {}, {}, {}, {}, {-1, -1}, false, input.close};
  if (!IsMinimized() && overlay.HasPointer()) walking.clicks.clear();
  const float aspect = static_cast<float>(std::max(1, width_px)) / static_cast<float>(std::max(1, height_px));
  TakeInput(walking, passed_s, aspect, for_pages, *s, &controls, &wishes);
  if (controls.toggles_views) views.shown = !views.shown;
  if (controls.switches_adaptation) SwitchAdaptation(s);
  if (controls.opens_pages) OpenPage(Page::kMain, &menu);
  controls.toggles_views = controls.switches_adaptation = controls.opens_pages = false;
  if (controls.applies) ApplySettings();
  controls.applies = false;
  window.FreePointer(controls.points || pages());
}

// Before the hands' wishes for the walk: what is pressed here is not meant for the town.
void Visit::ShowPages(const WindowInput& input, float passed_s) {
  const bool were_open = for_pages = pages();
  TakePageInput(input, &menu, &controls);
  if (IsMinimized()) return;
  overlay.PrepareText(PageLetter_px(width_px, height_px), pages() ? PageTexts(controls, *s) : "");
  overlay.Begin(width_px, height_px, OverlayInputFrom(input, menu, width_px, height_px, passed_s));
  const MenuChoice choice = ShowMenu(pack.name, *s, width_px, height_px, &menu, &controls);
  if (views.shown && !pages()) ShowViews(statistics, width_px, height_px, &views, s);
  if (controls.points && !pages() && ShowMenuButton(width_px, height_px)) OpenPage(Page::kMain, &menu);
  controls.quits = controls.quits || choice.ends;
  if (choice.stop) {
    JumpToStop(*choice.stop, s);
    looks = {};
  }
  if (were_open && !pages()) Save();
}

void Visit::StepTown(float passed_s) {
  const double step_s = static_cast<double>(s->step_s);
  owed_s = pages() ? 0 : std::min(owed_s + static_cast<double>(passed_s), step_s * kMostStepsAFrame);
  while (owed_s >= step_s) {
    StepSimulation(NextStep(wishes, *s, &controls), passed_s * 1000, s);
    Record(*s, {statistics.town_triangles, statistics.draw_ms}, &records);
    wishes.tour = {};
    wishes.walk_to.reset();
    owed_s -= step_s;
  }
  Narrate(s->tour, pages(), pack.sounds, &narration, &speaker);
  if (!pages()) FollowNotices(controls, *s, passed_s, &notices);
}

void Visit::Draw(float passed_s) {
  if (!IsMinimized()) {
    FrameFromSimulation(pack, *s, &looks, &frame);
    if (pages()) frame.caption.clear();
    else ShowNotice(notices, !controls.settings.reduced_motion, &frame);
    renderer.Draw(frame, width_px, height_px, &statistics);
    overlay.Draw();
    renderer.Present();
    RememberFrame(*s, statistics, passed_s * 1000, &views.history);
  }
  window.Show();
}

Error Visit::Play() {
  bool goes_on = false;
  if (Error e = Open(&goes_on)) return e;
  double clock_s = Now_s(), title_s = clock_s;
  int pictures = 0;
  while (goes_on) {
    if (Error e = loader->Upload(kUpload_ms, &renderer)) return e;
    const WindowInput input = window.Poll();
    if (options.seconds && static_cast<float>(s->frame) * s->step_s >= *options.seconds) break;
    const double now_s = Now_s();
    const auto passed_s = static_cast<float>(now_s - clock_s);
    clock_s = now_s;
    window.Size(&width_px, &height_px);
    ShowPages(input, passed_s);
    TakeHands(input, passed_s);
    if (controls.quits) break;
    StepTown(passed_s);
    Draw(passed_s);
    loader->GoOn();
    ++pictures;
    if (now_s - title_s > 1) {
      window.SetTitle(Title(pack.name, pictures / (now_s - title_s), *s, statistics).c_str());
      title_s = now_s;
      pictures = 0;
    }
  }
  Save();
  return WriteRecords(records, options.metrics, options.trajectories);
}

}  // namespace

Error RunInWindow(const PlayerOptions& options, const TourPack& pack, Loader* loader, UserSettings* user, Simulation* simulation) {
  Visit visit{options, pack, loader, user, simulation};
  return visit.Play();
}

}  // namespace flaneur
