// Visitors whose hands do anything whatever, one after the other, for so many seconds: random_visits PACK [SECONDS
// [SEED]]. Exit status: 0 nothing was wrong, 1 something was, 77 there is no pack or no OpenGL.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "runtime/base/clock.h"
#include "runtime/desktop/context.h"
#include "runtime/desktop/user_settings.h"
#include "runtime/show/guide_figure.h"
#include "runtime/simulation/scenario.h"
#include "runtime/visit/visit.h"
#include "tests/soak/drivers_stay_loaded.h"
#include "tests/soak/random_hands.h"
#include "tests/soak/wrong.h"
#include "tests/unit/runtime/visit/silent_shell.h"

namespace flaneur {
namespace {

constexpr int kSkipped = 77;
constexpr int kMaxPeople = 300;

struct Counts {
  long visits = 0, unfinished = 0, pictures = 0, of_pages = 0, steps = 0;
};

// What must hold whatever anybody does; empty: it does.
std::string Wrong(const Simulation& s, const std::filesystem::path& settings) {
  if (const std::string wrong = WhatIsWrong(s); !wrong.empty()) return wrong;
  PlayerSettings read;
  std::vector<std::string> warnings;
  if (Error e = ReadPlayerSettings(settings, &read, &warnings)) return e.message;
  return warnings.empty() ? "" : warnings.front();
}

Error Play(const std::filesystem::path& path, double until_s, const std::filesystem::path& settings, RandomHands* hands,
           Counts* counts) {
  TourPack pack;
  PackFile file;
  if (Error e = file.Open(path, &pack)) return e;
  AddGuideFigure(&pack);
  Scenario scenario = ScenarioOf(pack);
  scenario.crowd.people = hands->Below(kMaxPeople);
  scenario.crowd.seed = static_cast<uint64_t>(hands->Below(1000));
  if (hands->Share() < 0.5) scenario.hour = static_cast<float>(24 * hands->Share());
  if (hands->Share() < 0.2) pack.path.clear();
  Jobs jobs(static_cast<size_t>(hands->Below(5)));
  Simulation s;
  if (Error e = StartSimulation(&pack, scenario, &s, &jobs)) return e;
  UserSettings user;
  user.path = settings;
  user.settings = user.in_file = hands->NextSettings();
  user.may_save = true;
  HeadlessContext context;
  if (Error e = context.Create()) return e;
  Loader loader(&jobs);
  loader.Start(std::move(file), pack);
  SilentShell silent;
  UserSettingsStore store(&user);
  Visit visit(pack, &loader, user.settings, {silent.sound, store, silent.warnings, {}}, &s);
  if (Error e = visit.Begin()) return e;
  ++counts->visits;
  const bool leaves_early = hands->Share() < 0.2;
  for (bool there = false; !there;) {
    if (Error e = visit.Load(&there)) return e;
    if (leaves_early && hands->Share() < 0.01) return ++counts->unfinished, Ok();
  }
  if (Error e = visit.Enter(hands->Share() < 0.3)) return e;
  int width_px = 160, height_px = 90;
  Records records;
  const double end_s = std::min(until_s, Now_s() + 2 + 40 * hands->Share());
  while (Now_s() < end_s) {
    hands->NextSize(&width_px, &height_px);
    if (Error e = visit.Picture(hands->Next(), width_px, height_px, hands->NextPause_s(), &records)) return e;
    ++counts->pictures;
    counts->of_pages += visit.shows_pages();
    if (const std::string wrong = Wrong(s, settings); !wrong.empty()) return Fail(wrong);
  }
  visit.Leave();
  counts->steps += static_cast<long>(s.town.step);
  return Ok();
}

int Run(const std::filesystem::path& pack, double seconds, uint64_t seed) {
  std::error_code ec;
  if (!std::filesystem::exists(pack, ec)) {
    std::printf("no %s: bake the demo tour with ./demo\n", pack.c_str());
    return kSkipped;
  }
  if (HeadlessContext context; Error e = context.Create()) {
    std::printf("%s\n", e.message.c_str());
    return kSkipped;
  }
  const auto settings =
      std::filesystem::temp_directory_path() / ("flaneur_random_visits_" + std::to_string(seed) + ".toml");
  RandomHands hands(seed);
  Counts counts;
  Error error;
  const double until_s = Now_s() + seconds;
  while (!error && Now_s() < until_s) {
    std::filesystem::remove(settings, ec);
    error = Play(pack, until_s, settings, &hands, &counts);
  }
  std::filesystem::remove(settings, ec);
  std::printf("seed %llu: %ld visits (%ld left while loading), %ld pictures (%ld of them with pages), %ld steps\n",
              static_cast<unsigned long long>(seed), counts.visits, counts.unfinished, counts.pictures, counts.of_pages,
              counts.steps);
  if (error) std::printf("wrong: %s\n", error.message.c_str());
  return error ? 1 : 0;
}

}  // namespace
}  // namespace flaneur

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "random_visits PACK [SECONDS [SEED]]\n");
    return 2;
  }
  return flaneur::Run(argv[1], argc > 2 ? std::atof(argv[2]) : 20, argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1);
}
