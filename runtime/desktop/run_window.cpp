#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

#include "runtime/base/clock.h"
#include "runtime/desktop/context.h"
#include "runtime/desktop/run.h"
#include "runtime/desktop/speaker.h"
#include "runtime/desktop/warn.h"
#include "runtime/desktop/watchdog.h"
#include "runtime/simulation/records.h"
#include "runtime/text/system_fonts.h"
#include "runtime/visit/visit.h"

namespace flaneur {
namespace {

const double program_start_s = Now_s();
constexpr double kPause_s = 0.002;  // between looks at whether the town is there

void TellStart() {
  std::fprintf(stderr, "flaneur-player: first picture after %.2f s, %.2f s of processor time\n",
               Now_s() - program_start_s, static_cast<double>(std::clock()) / CLOCKS_PER_SEC);
}

// What a visit looks like from inside, for who looks for faults.
std::string Figures(const std::string& name, double frames_per_s, const Simulation& s,
                    const FrameStatistics& statistics) {
  char title[200];
  const char* tour = s.visitor.tour.over                                ? " - tour over"
                     : s.visitor.tour.paused && HasTour(s.visitor.tour) ? " - tour paused"
                                                                        : "";
  std::snprintf(title, sizeof title, "%s%s - %.0f frames/s at %.0f %%, %zu people, %lld triangles", name.c_str(), tour,
                frames_per_s, 100 * static_cast<double>(statistics.resolution_scale), s.town.crowd.size(),
                static_cast<long long>(statistics.people_triangles + statistics.town_triangles));
  return title;
}

// Nothing can be tidied up in here: what the visitor changed was saved when the pages closed.
void EndWithoutWindow(const char* why) {
  std::fprintf(stderr, "flaneur-player: error: %s\n", why);
  std::_Exit(2);
}

// Until there is enough for a picture; `closed`: the window was, meanwhile.
Error WaitForTown(bool may_close, Window* window, Visit* visit, bool* closed) {
  for (bool there = false; !there && !*closed;) {
    if (Error e = visit->Load(&there)) return e;
    *closed = window->Poll(there ? 0 : kPause_s).close && may_close;
    TellAlive(false);
  }
  return Ok();
}

}  // namespace

Error RunInWindow(const PlayerOptions& options, const TourPack& pack, Jobs* jobs, Loader* loader, UserSettings* user,
                  Simulation* s, bool* starts_anew) {
  Window window;
  const std::string title = TitleOf(pack, s->visitor.tour.language);
  const bool fullscreen = user->settings.fullscreen;
  const std::string& monitor = options.monitor.empty() ? user->kiosk.monitor : options.monitor;
  if (Error e = window.Create({options.width_px, options.height_px, title, monitor, fullscreen}, EndWithoutWindow))
    return e;
  Speaker speaker(jobs);
  UserSettingsStore store(user);
  WarningsOnStderr warnings;
  Fonts fonts(SystemFonts());
  Visit visit(pack, loader, user->settings, {speaker, store, warnings, PrintedKey, &fonts}, s, user->kiosk);
  if (Error e = visit.Begin(true)) return e;
  bool closed = false;
  if (Error e = WaitForTown(!user->settings.kiosk, &window, &visit, &closed)) return e;
  if (closed) return Ok();
  if (Error e = visit.Enter(options.views)) return e;
  Records records;
  records.keep_metrics = !options.metrics.empty();
  records.keep_trajectories = !options.trajectories.empty();
  double clock_s = Now_s(), title_s = clock_s;
  int pictures = 0;
  bool shown = false;
  while (!visit.ends() && !(options.seconds && static_cast<float>(s->town.step) * Step_s(*s) >= *options.seconds)) {
    const WindowInput input = window.Poll();
    const double now_s = Now_s(), passed_s = now_s - clock_s;
    clock_s = now_s;
    int width_px = 0, height_px = 0;
    window.Size(&width_px, &height_px);
    if (Error e = visit.Picture(input, width_px, height_px, static_cast<float>(passed_s), &records)) return e;
    visit.Present();
    window.FreePointer(visit.frees_pointer());
    window.SetFullscreen(visit.fullscreen());
    const double ready_s = Now_s();
    window.Show();
    visit.TellTime(static_cast<float>(1000 * ((window.ShowWaits() ? ready_s : Now_s()) - now_s)));
    TellAlive(true);
    if (!shown && options.verbose) TellStart();
    shown = true;
    ++pictures;
    if (!options.verbose || now_s - title_s <= 1) continue;
    window.SetTitle(Figures(title, pictures / (now_s - title_s), *s, visit.statistics()).c_str());
    title_s = now_s;
    pictures = 0;
  }
  visit.Leave();
  *starts_anew = visit.starts_anew();
  return WriteRecords(records, options.metrics, options.trajectories);
}

}  // namespace flaneur
