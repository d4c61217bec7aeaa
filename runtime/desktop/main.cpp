#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/base/memory.h"
#include "runtime/base/text.h"
#include "runtime/desktop/options.h"
#include "runtime/desktop/run.h"
#include "runtime/desktop/stills.h"
#include "runtime/desktop/tour_start.h"
#include "runtime/desktop/user_settings.h"
#include "runtime/desktop/warn.h"
#include "runtime/desktop/watchdog.h"

namespace flaneur {
namespace {

Error CheckOutputs(const PlayerOptions& options) {
  for (const auto* path : {&options.metrics, &options.trajectories}) {
    if (path->empty()) continue;
    if (Error e = CheckWritable(*path)) return e;
  }
  if (!options.film.empty()) {
    if (Error e = CheckReplaceable(options.film)) return e;
  }
  for (const Still& still : StillsOf(options, 1)) {
    if (Error e = CheckWritable(still.path)) return e;
  }
  return Ok();
}

Error Play(const PlayerOptions& options, UserSettings* user, bool* starts_anew) {
  if (Error e = CheckOutputs(options)) return e;
  if (options.pack.empty() && !options.no_draw)
    return Fail("nothing to draw without a pack; add --headless --no-draw or name a pack");
  StartingTour tour(options);
  if (!options.headless) return RunInWindow(options, &tour, user, starts_anew);
  if (!options.no_draw) return RunHeadless(options, user->settings, &tour);
  if (Error e = OpenTour(options, &tour)) return e;
  if (Error e = StartSimulations(options, &tour)) return e;
  WarnOfTour(tour);
  const float seconds = RunLength_s(options, tour.scenario, tour.simulations.front());
  return RunWithoutDrawing(options, seconds, &tour.simulations.front());
}

// The exit status, unless something is wrong.
Error Run(PlayerOptions options, char** argv, int* status) {
  UserSettings user;
  if (!options.headless || options.save_settings) {
    if (Error e = ReadUserSettings(options, &user)) return e;
  } else if (Error e = TakeOptions(options, &user.settings)) {
    return e;
  }
  if (options.save_settings) return SaveUserSettings(user.settings, user);
  if (user.settings.kiosk) {
    if (options.pack.empty()) options.pack = user.kiosk.tour;
    if (options.pack.empty() && options.scenario.empty())
      return Fail("a pack is missing: name it, or say tour = \"FILE\" in the kiosk's settings");
    if (const auto over = Watch({.hang_s = user.kiosk.hang_s}, argv)) {
      *status = *over;
      return Ok();
    }
  }
  bool starts_anew = false;
  if (Error e = Play(options, &user, &starts_anew)) return e;
  if (starts_anew) *status = kStartAnewStatus;
  return Ok();
}

}  // namespace
}  // namespace flaneur

int main(int argc, char** argv) {
  flaneur::KeepNoLargeStock();
  flaneur::PlayerOptions options;
  if (const int status = flaneur::ParsePlayerOptions(argc, argv, &options); status >= 0) return status;
  int status = 0;
  flaneur::Error error;
  try {
    error = flaneur::Run(options, argv, &status);
  } catch (const std::bad_alloc&) {
    error = flaneur::Fail("there is not enough memory for this");
  } catch (const std::exception& e) {
    error = flaneur::Fail(std::string("this cannot be played: ") + e.what());
  }
  if (!error) return status;
  std::fprintf(stderr, "flaneur-player: error: %s\n", flaneur::OneLine(error.message).c_str());
  return 2;
}
