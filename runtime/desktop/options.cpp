#include "runtime/desktop/options.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>
#include <string_view>

#include "runtime/base/option_range.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

constexpr int kLeastPictureSide_px = 16, kMostPictureSide_px = 8192;

int Refuse(const std::string& why) {
  std::fprintf(stderr, "flaneur-player: error: %s; see flaneur-player --help\n", OneLine(why).c_str());
  return 2;
}

bool ParseSide(std::string_view text, int* side_px) {
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, *side_px);
  return read.ec == std::errc() && read.ptr == end && *side_px >= kLeastPictureSide_px &&
         *side_px <= kMostPictureSide_px;
}

bool ParseSize(std::string_view text, PlayerOptions* o) {
  const size_t x = text.find('x');
  return x != std::string_view::npos && ParseSide(text.substr(0, x), &o->width_px) &&
         ParseSide(text.substr(x + 1), &o->height_px);
}

}  // namespace

int ParsePlayerOptions(int argc, char** argv, PlayerOptions* o) {
  CLI::App app{
      "Plays a tour pack: a walk through a historic town among its townspeople.\n"
      "In the window: W A S D or arrows walk and the mouse looks; a click walks to where it points. Tab: guided tour "
      "or "
      "free walk; space pauses the tour, N goes to the next stop, B back; L changes the language, M frees the pointer, "
      "- and = change the field of view, Esc opens the pages with all settings. Gamepads work too. docs/player.md says "
      "how to change all that.\n"
      "Exit status: 0 done, 2 bad usage or input.",
      "flaneur-player"};
  std::string size = "1280x720";
  app.set_version_flag("--version", "flaneur-player " FLANEUR_VERSION, "Print the version and exit");
  app.add_option("PACK", o->pack, "Tour pack (.glb); not needed where the scenario brings its own ground");
  app.add_flag("--headless", o->headless, "No window: run by itself, as fast as it goes");
  app.add_flag("--no-draw", o->no_draw, "With --headless: the simulation alone, without OpenGL");
  app.add_flag("--views", o->views,
               "Show the plan of the town and graphs over the picture (in the window: F1; F2 switches the adaptation)");
  app.add_flag("--verbose", o->verbose,
               "Say when a window's title page and first picture were there, and have the window's title tell pictures "
               "a second");
  app.add_flag("--fullscreen", o->fullscreen, "Fill the screen; F11 does so too, and back");
  app.add_option("--monitor", o->monitor, "Open the window on this monitor: its number, from 1, or its name");
  app.add_option("--seconds", o->seconds,
                 "End after so much simulated time (default: the scenario's, else the guided tour's end, else 60)")
      ->check(NumberFrom(0.0, 1e6));
  app.add_option("--scenario", o->scenario, "Scenario file (TOML)");
  app.add_option("--metrics", o->metrics, "Write one row a frame (CSV)");
  app.add_option("--trajectories", o->trajectories, "Write one row a person a frame (CSV)");
  app.add_option("--screenshot", o->screenshot, "Write the last picture (PNG)");
  app.add_option("--at", o->at_s,
                 "Moments of --screenshot in seconds, such as 10,25.5: a still each, FILE_10s.png and FILE_25.5s.png")
      ->delimiter(',')
      ->check(NumberFrom(0.0, 1e6));
  app.add_option("--film", o->film, "Write a film (MP4, H.264)");
  app.add_option("--samples", o->samples,
                 "Samples a pixel of --screenshot and --film (default: 4, but 1 for films without a graphics card)")
      ->check(CLI::IsMember({1, 2, 4, 8}));
  app.add_option("--size", size, "Picture size in pixels")->capture_default_str();
  app.add_option("--people", o->people, "How many people (default: the scenario's, else the pack's)")
      ->check(CLI::Range(0, 1000000));
  app.add_option("--seed", o->seed, "Seed of the crowd (default: likewise)");
  app.add_option("--hour", o->hour,
                 "Hour of the day at the start, such as 19.5 (default: likewise); it sets sun and sky")
      ->check(NumberFrom(0.0, 24.0));
  app.add_option("--adaptation", o->adaptation,
                 "How the crowd keeps out of the visitor's way: off, paper or full (default: likewise)")
      ->check(CLI::IsMember({"off", "paper", "full"}));
  app.add_option("--discretion", o->discretion,
                 "With full adaptation: 1 for unnoticed, 0 for the limit at any price (default: likewise)")
      ->check(NumberFrom(0.0, 1.0));
  app.add_option("--language", o->language,
                 "Of the guided tour's captions and sounds, such as en (default: the tour's own)");
  app.add_flag("--kiosk", o->kiosk,
               "For exhibitions: full screen, visitor after visitor, locked but for the operator's PIN, watched and "
               "started anew when it crashes or hangs");
  app.add_option("--kiosk-settings", o->kiosk_settings,
                 "With --kiosk: its file (default: $XDG_CONFIG_HOME/flaneur/kiosk.toml, else /etc/flaneur/kiosk.toml)");
  app.add_option(
      "--photos", o->photos,
      "Folder where visitors' photos are kept (default: Pictures/Flaneur in your home; in an exhibition none)");
  app.add_option("--settings", o->settings, "Settings file (default: $XDG_CONFIG_HOME/flaneur/player.toml)");
  app.add_option("--set", o->set,
                 "SETTING=VALUE instead of what the settings file says, such as snap_turn_deg=30 or keys.pause=p,pad_a")
      ->allow_extra_args(false);
  app.add_flag("--save-settings", o->save_settings, "Write the settings as they are now, with --set, and end");
  app.add_option(
         "--threads", o->threads,
         "Threads that work beside the one that plays (default: one a core, two at least); 0: it does all itself")
      ->check(CLI::Range(0, 256));
  app.add_option("--pack-memory-mib", o->pack_memory_mib,
                 "Memory that a pack may ask for beside its file, and as much again for its pictures")
      ->check(CLI::Range(16, 65536))
      ->capture_default_str();
  app.add_option("--compare", o->compare,
                 "Two adaptations on the same walk, side by side in one film or picture, such as: off full")
      ->expected(2)
      ->check(CLI::IsMember({"off", "paper", "full"}));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);
    return Refuse(e.what());
  }
  if (!ParseSize(size, o)) return Refuse("--size must be WIDTHxHEIGHT in pixels, 16 to 8192 each, not '" + size + "'");
  if (o->pack.empty() && o->scenario.empty() && !o->save_settings && !o->kiosk) return Refuse("a pack is missing");
  if (o->no_draw && !o->headless) return Refuse("--no-draw needs --headless");
  if (o->no_draw && o->views) return Refuse("--no-draw makes no pictures for --views; leave one out");
  if (o->views && !o->compare.empty()) return Refuse("--views is for one run; leave out --compare");
  if (o->no_draw && (!o->screenshot.empty() || !o->film.empty()))
    return Refuse("--no-draw makes no pictures; leave it out");
  if (o->headless && (o->fullscreen || o->kiosk || !o->monitor.empty()))
    return Refuse("--fullscreen, --kiosk and --monitor are for a window; leave out --headless");
  if (!o->kiosk && !o->kiosk_settings.empty()) return Refuse("--kiosk-settings is for --kiosk");
  if (!o->headless && (!o->screenshot.empty() || !o->film.empty()))
    return Refuse("--screenshot and --film need --headless");
  if (!o->at_s.empty() && o->screenshot.empty()) return Refuse("--at is for --screenshot");
  if (o->samples && o->screenshot.empty() && o->film.empty()) return Refuse("--samples is for --film and --screenshot");
  if (o->compare.empty()) return -1;
  if (o->screenshot.empty() && o->film.empty()) return Refuse("--compare is for --film and --screenshot");
  if (o->adaptation || !o->metrics.empty() || !o->trajectories.empty()) {
    return Refuse("--compare plays two runs; leave out --adaptation, --metrics and --trajectories, which are of one");
  }
  if (o->width_px % 2 != 0) return Refuse("--compare needs an even width");
  return -1;
}

}  // namespace flaneur
