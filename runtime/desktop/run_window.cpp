#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <memory>
#include <string>

#include "runtime/base/clock.h"
#include "runtime/desktop/context.h"
#include "runtime/desktop/kiosk_files.h"
#include "runtime/desktop/run.h"
#include "runtime/desktop/speaker.h"
#include "runtime/desktop/title_screen.h"
#include "runtime/desktop/warn.h"
#include "runtime/desktop/watchdog.h"
#include "runtime/simulation/records.h"
#include "runtime/text/system_fonts.h"
#include "runtime/visit/visit.h"

namespace flaneur {
namespace {

const double program_start_s = Now_s();
constexpr double kPause_s = 0.002;  // between looks at how far the loading is

void TellOf(const char* what) {
  std::fprintf(stderr, "flaneur-player: %s after %.2f s, %.2f s of processor time\n", what, Now_s() - program_start_s,
               static_cast<double>(std::clock()) / CLOCKS_PER_SEC);
}

// What a visit looks like from inside, for who looks for faults.
std::string Figures(const std::string& name, double frames_per_s, const Simulation& s,
                    const FrameStatistics& statistics) {
  const char* tour = s.visitor.tour.over                                ? " - tour over"
                     : s.visitor.tour.paused && HasTour(s.visitor.tour) ? " - tour paused"
                                                                        : "";
  char figures[120];
  std::snprintf(figures, sizeof figures, " - %.0f frames/s at %.0f %%, %zu people, %lld triangles", frames_per_s,
                100 * static_cast<double>(statistics.resolution_scale), s.town.crowd.size(),
                static_cast<long long>(statistics.people_triangles + statistics.town_triangles));
  return name + tour + figures;
}

// Nothing can be tidied up in here: what the visitor changed was saved when the pages closed.
void EndWithoutWindow(const char* why) {
  std::fprintf(stderr, "flaneur-player: error: %s\n", why);
  std::_Exit(2);
}

// Meanwhile the title page is shown. `closed`: the window was.
struct Loading {
  Window& window;
  TitleScreen& title;
  bool may_close;
  bool closed = false;

  void ShowTitle(float share) {
    title.Show(share);
    closed = closed || (window.Poll(kPause_s).close && may_close);
    TellAlive(false);
  }
};

// A part of the loading beside the title page.
class Part {
 public:
  Part(Jobs* jobs, const std::function<Error()>& part)
      : error_(std::make_unique<Error>()),
        job_(StartJob(jobs, [error = error_.get(), part] { return *error = part(), true; })) {}
  // share: of the loading, that is done with it.
  Error Finish(float share, Loading* loading) {
    while (!job_.Done() && !loading->closed) {
      job_.Advance();
      loading->ShowTitle(share);
    }
    job_.Wait();
    return std::move(*error_);
  }

 private:
  std::unique_ptr<Error> error_;
  Job job_;  // last, so that it ends first
};

// Until there is enough to walk through, with its people.
Error WaitForTown(Visit* visit, Loader* loader, float from_share, Loading* loading) {
  for (bool there = false; !there && !loading->closed;) {
    if (Error e = visit->Load(&there)) return e;
    loading->ShowTitle(from_share + (1 - from_share) * loader->ShareOfLikenesses());
  }
  return Ok();
}

WindowOptions WindowFor(const PlayerOptions& options, const UserSettings& user, const std::string& title) {
  const std::string& monitor = options.monitor.empty() ? user.kiosk.monitor : options.monitor;
  return {options.width_px, options.height_px, title, monitor, user.settings.fullscreen};
}

}  // namespace

Error RunInWindow(const PlayerOptions& options, StartingTour* tour, UserSettings* user, bool* starts_anew) {
  constexpr float kOpened = 0.2f, kStarted = 0.35f;  // of the loading
  PackTitle pack_title;
  const bool opens_later = ReadPackTitle(options.pack, user->settings.language, &pack_title);
  if (!opens_later) {
    if (Error e = OpenTour(options, tour)) return e;  // says what is wrong
  }
  Window window;
  if (Error e = window.Create(WindowFor(options, *user, pack_title.title), EndWithoutWindow)) return e;
  TitleScreen title(pack_title, &window);
  Loading loading{window, title, !user->settings.kiosk};
  title.Show(0);
  window.Appear();
  loading.ShowTitle(0);
  if (options.verbose) TellOf("title page");
  Part open(&tour->jobs, [&] { return opens_later ? OpenTour(options, tour) : Ok(); });
  if (Error e = open.Finish(kOpened, &loading)) return e;
  if (loading.closed) return Ok();
  tour->loader.Start(std::move(tour->file), tour->pack);
  Simulation* s = &tour->simulations.front();
  Speaker speaker(&tour->jobs);
  UserSettingsStore store(user);
  WarningsOnStderr warnings;
  Fonts fonts(SystemFonts());
  VisitLogFile visits(user->kiosk);
  PackWatch pack_file(options.pack);
  const Shell shell{speaker, store, warnings, PrintedKey, &fonts, &tour->jobs, &visits};
  Visit visit(tour->pack, &tour->loader, user->settings, shell, s, user->kiosk);
  Part simulations(&tour->jobs, [&] { return StartSimulations(options, tour); });
  if (Error e = visit.Begin(true)) return e;
  if (Error e = simulations.Finish(kStarted, &loading)) return e;
  if (loading.closed) return Ok();
  WarnOfTour(*tour);
  if (Error e = WaitForTown(&visit, &tour->loader, kStarted, &loading)) return e;
  if (loading.closed) return Ok();
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
    if (visit.waits_for_visitors() && pack_file.IsReplaced(now_s)) {
      *starts_anew = true;
      break;
    }
    if (!shown && options.verbose) TellOf("first picture");
    shown = true;
    ++pictures;
    if (!options.verbose || now_s - title_s <= 1) continue;
    window.SetTitle(Figures(pack_title.title, pictures / (now_s - title_s), *s, visit.statistics()).c_str());
    title_s = now_s;
    pictures = 0;
  }
  visit.Leave();
  *starts_anew = *starts_anew || visit.starts_anew();
  return WriteRecords(records, options.metrics, options.trajectories);
}

}  // namespace flaneur
