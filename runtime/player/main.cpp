#include <algorithm>
#include <cstdio>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/base/text.h"
#include "runtime/player/guide_figure.h"
#include "runtime/player/loading.h"
#include "runtime/player/options.h"
#include "runtime/player/player_settings.h"
#include "runtime/player/run.h"
#include "runtime/player/scenario.h"

namespace flaneur {
namespace {

Error CheckOutputs(const PlayerOptions& options) {
  for (const auto* path : {&options.metrics, &options.trajectories, &options.screenshot, &options.film}) {
    if (path->empty()) continue;
    if (Error e = CheckWritable(*path)) return e;
  }
  return Ok();
}

void Warn(const std::string& what) { std::fprintf(stderr, "flaneur-player: warning: %s\n", OneLine(what).c_str()); }

// A file with something wrong in it is used as far as it goes, and never written to.
struct UserSettings {
  std::filesystem::path path;
  PlayerSettings in_file, settings;  // settings: with what the command line says
  bool may_save = false;
};

Error ReadUserSettings(const PlayerOptions& options, UserSettings* user) {
  user->path = options.settings.empty() ? PlayerSettingsPath() : options.settings;
  std::vector<std::string> wrong;
  if (Error e = ReadPlayerSettings(user->path, &user->in_file, &wrong)) wrong = {e.message};
  user->settings = user->in_file;
  user->may_save = wrong.empty() && !user->path.empty();
  if (!wrong.empty()) {
    const std::string more = wrong.size() > 1 ? " (and " + std::to_string(wrong.size() - 1) + " more)" : "";
    Warn(wrong.front() + more + "; the default is used, and the file stays as it is");
  }
  for (const std::string& assignment : options.set) {
    if (Error e = SetPlayerSetting(assignment, &user->settings)) return Fail("--set: " + e.message);
  }
  if (options.language) user->settings.language = *options.language;
  return Ok();
}

Error SaveSettings(const UserSettings& user, const PlayerSettings& settings) {
  if (user.may_save) return WritePlayerSettings(user.path, settings);
  return user.path.empty() ? Fail("there is no folder for settings: neither XDG_CONFIG_HOME nor HOME is set; name a file with --settings")
                           : Fail(user.path.string() + ": has something wrong in it, so nothing is saved over it; mend or remove it");
}

Error PlayInWindow(const PlayerOptions& options, const TourPack& pack, Loader* loader, Simulation* simulation) {
  UserSettings user;
  if (Error e = ReadUserSettings(options, &user)) return e;
  Controls controls = MakeControls(user.settings, *simulation);
  if (Error e = RunInWindow(options, pack, loader, &controls, simulation)) return e;
  if (!controls.changed) return Ok();
  // What was changed in the window, and not what only the command line said.
  PlayerSettings kept = user.in_file;
  const PlayerSettings &before = user.settings, &now = controls.settings;
  if (now.language != before.language) kept.language = now.language;
  if (now.pointer != before.pointer) kept.pointer = now.pointer;
  if (now.field_of_view_deg != before.field_of_view_deg) kept.field_of_view_deg = now.field_of_view_deg;
  if (Error e = SaveSettings(user, kept)) Warn(e.message);
  return Ok();
}

Error Play(const PlayerOptions& options) {
  if (options.save_settings) {
    UserSettings user;
    if (Error e = ReadUserSettings(options, &user)) return e;
    return SaveSettings(user, user.settings);
  }
  if (Error e = CheckOutputs(options)) return e;
  Scenario scenario;
  if (!options.scenario.empty()) {
    if (Error e = ReadScenario(options.scenario, &scenario)) return e;
  }
  if (options.people) scenario.people = *options.people;
  if (options.seed) scenario.seed = *options.seed;
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
