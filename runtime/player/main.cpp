#include <algorithm>
#include <cstdio>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/base/text.h"
#include "runtime/player/guide_figure.h"
#include "runtime/player/loading.h"
#include "runtime/player/options.h"
#include "runtime/player/run.h"
#include "runtime/player/scenario.h"
#include "runtime/player/stills.h"
#include "runtime/player/user_settings.h"
#include "runtime/player/warn.h"

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

Error PlayInWindow(const PlayerOptions& options, const TourPack& pack, Loader* loader, Simulation* simulation) {
  UserSettings user;
  if (Error e = ReadUserSettings(options, &user)) return e;
  return RunInWindow(options, pack, loader, &user, simulation);
}

Error Play(const PlayerOptions& options) {
  if (options.save_settings) {
    UserSettings user;
    if (Error e = ReadUserSettings(options, &user)) return e;
    return SaveUserSettings(user.settings, user);
  }
  if (Error e = CheckOutputs(options)) return e;
  Scenario scenario;
  if (!options.scenario.empty()) {
    if (Error e = ReadScenario(options.scenario, &scenario)) return e;
  }
  if (options.people) scenario.people = *options.people;
  if (options.seed) scenario.seed = *options.seed;
  if (options.hour) scenario.hour = *options.hour;
  if (options.adaptation) scenario.adaptation = *options.adaptation;
  scenario.language = options.language;

  TourPack pack;
  Loader loader;
  if (!options.pack.empty()) {
    PackFile file;
    if (Error e = file.Open(options.pack, &pack)) return e;
    AddGuideFigure(&pack);
    if (!options.no_draw) loader.Start(std::move(file), pack);
  } else if (!options.no_draw) {
    return Fail("nothing to draw without a pack; add --headless --no-draw or name a pack");
  }
  std::vector<Simulation> simulations(std::max<size_t>(1, options.compare.size()));
  for (size_t k = 0; k < simulations.size(); ++k) {
    if (!options.compare.empty()) scenario.adaptation = options.compare[k];
    if (Error e = StartSimulation(options.pack.empty() ? nullptr : &pack, scenario, &simulations[k])) {
      const auto& source = options.scenario.empty() ? options.pack : options.scenario;
      return Fail(source.string() + ": " + e.message);
    }
  }
  Simulation& simulation = simulations.front();
  for (const std::string& warning : simulation.warnings) Warn(warning);
  const float seconds = RunLength_s(options, scenario, simulation);
  if (options.no_draw) return RunWithoutDrawing(options, seconds, &simulation);
  if (options.headless) return RunHeadless(options, seconds, pack, &loader, &simulations);
  return PlayInWindow(options, pack, &loader, &simulation);
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
