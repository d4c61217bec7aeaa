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

Error PlayInWindow(const PlayerOptions& options, const TourPack& pack, Jobs* jobs, Loader* loader,
                   Simulation* simulation) {
  UserSettings user;
  if (Error e = ReadUserSettings(options, &user)) return e;
  return RunInWindow(options, pack, jobs, loader, &user, simulation);
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
  return Ok();
}

Error Play(const PlayerOptions& options) {
  if (options.save_settings) {
    UserSettings user;
    if (Error e = ReadUserSettings(options, &user)) return e;
    return SaveUserSettings(user.settings, user);
  }
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
  return PlayInWindow(options, pack, &jobs, &loader, &simulation);
}

}  // namespace
}  // namespace flaneur

int main(int argc, char** argv) {
  flaneur::PlayerOptions options;
  if (const int status = flaneur::ParsePlayerOptions(argc, argv, &options); status >= 0) return status;
  const flaneur::Error error = flaneur::Play(options);
  if (!error) return 0;
  std::fprintf(stderr, "flaneur-player: error: %s\n", flaneur::OneLine(error.message).c_str());
  return 2;
}
