#include <algorithm>
#include <cstdio>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/base/text.h"
#include "runtime/desktop/options.h"
#include "runtime/desktop/run.h"
#include "runtime/desktop/stills.h"
#include "runtime/desktop/user_settings.h"
#include "runtime/desktop/warn.h"
#include "runtime/desktop/watchdog.h"
#include "runtime/show/guide_figure.h"
#include "runtime/simulation/scenario.h"
#include "runtime/visit/loading.h"

namespace flaneur {
namespace {

Error CheckOutputs(const PlayerOptions& options) {
  for (const auto* path : {&options.metrics, &options.trajectories, &options.film}) {
    if (path->empty()) continue;
    if (Error e = CheckWritable(*path)) return e;
  }
  for (const Still& still : StillsOf(options, 1)) {
    if (Error e = CheckWritable(still.path)) return e;
  }
  return Ok();
}

// The scenario's file, and over it what the command line says.
Error TakeOptions(const PlayerOptions& options, Scenario* scenario) {
  if (!options.scenario.empty()) {
    if (Error e = ReadScenario(options.scenario, scenario)) return e;
  }
  if (options.people) scenario->crowd.people = *options.people;
  if (options.seed) scenario->crowd.seed = *options.seed;
  if (options.hour) scenario->hour = *options.hour;
  if (options.adaptation) TakeNamed(*options.adaptation, kAdaptationNames, &scenario->control.adaptation);
  scenario->language = options.language;
  scenario->screen_width_px = options.width_px / static_cast<int>(std::max<size_t>(1, options.compare.size()));
  scenario->screen_height_px = options.height_px;
  return Ok();
}

Error Play(const PlayerOptions& options, UserSettings* user, bool* starts_anew) {
  if (Error e = CheckOutputs(options)) return e;
  TourPack pack;
  PackFile file;
  const bool has_pack = !options.pack.empty();
  if (has_pack) {
    if (Error e = file.Open(options.pack, &pack)) return e;
    AddGuideFigure(&pack);
  } else if (!options.no_draw) {
    return Fail("nothing to draw without a pack; add --headless --no-draw or name a pack");
  }
  Scenario scenario = has_pack ? ScenarioOf(pack) : Scenario{};
  if (Error e = TakeOptions(options, &scenario)) return e;
  Jobs jobs(options.threads ? static_cast<size_t>(*options.threads) : ThreadsOfThisMachine());
  Loader loader(&jobs);
  if (has_pack && !options.no_draw) loader.Start(std::move(file), pack);
  std::vector<Simulation> simulations(std::max<size_t>(1, options.compare.size()));
  for (size_t k = 0; k < simulations.size(); ++k) {
    if (!options.compare.empty()) TakeNamed(options.compare[k], kAdaptationNames, &scenario.control.adaptation);
    if (Error e = StartSimulation(has_pack ? &pack : nullptr, scenario, &simulations[k], &jobs)) {
      const auto& source = options.scenario.empty() ? options.pack : options.scenario;
      return Fail(source.string() + ": " + e.message);
    }
  }
  Simulation& simulation = simulations.front();
  for (const std::string& warning : simulation.town.warnings) Warn(warning);
  const float seconds = RunLength_s(options, scenario, simulation);
  if (options.no_draw) return RunWithoutDrawing(options, seconds, &simulation);
  if (options.headless) return RunHeadless(options, seconds, pack, &loader, &simulations);
  return RunInWindow(options, pack, &jobs, &loader, user, &simulation, starts_anew);
}

// The exit status, unless something is wrong.
Error Run(PlayerOptions options, char** argv, int* status) {
  UserSettings user;
  if (!options.headless || options.save_settings) {
    if (Error e = ReadUserSettings(options, &user)) return e;
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
  flaneur::PlayerOptions options;
  if (const int status = flaneur::ParsePlayerOptions(argc, argv, &options); status >= 0) return status;
  int status = 0;
  const flaneur::Error error = flaneur::Run(options, argv, &status);
  if (!error) return status;
  std::fprintf(stderr, "flaneur-player: error: %s\n", flaneur::OneLine(error.message).c_str());
  return 2;
}
