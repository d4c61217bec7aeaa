// What flaneur-player is asked to do.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/limits.h"

namespace flaneur {

inline constexpr uint64_t kBytesAMebibyte = 1048576;

struct PlayerOptions {
  std::filesystem::path pack, scenario, metrics, trajectories, screenshot, film;
  bool headless = false, no_draw = false, views = false, verbose = false;
  bool fullscreen = false, kiosk = false;
  std::filesystem::path kiosk_settings;  // empty: where they are usually
  std::string monitor;                   // empty: any
  std::filesystem::path photos;          // folder; empty: as the settings say
  std::filesystem::path settings;        // empty: the user's own
  std::vector<std::string> set;          // SETTING=VALUE, over those of the file
  bool save_settings = false;
  std::optional<float> seconds, hour, discretion;
  std::vector<float> at_s;  // moments of the stills; empty: the last picture
  std::optional<int> people;
  std::optional<uint64_t> seed;
  std::optional<std::string> adaptation, language;
  std::vector<std::string> compare;  // adaptations side by side: two, or none
  int width_px = 1280, height_px = 720;
  std::optional<int> samples;  // a pixel, of stills and films
  int pack_memory_mib = static_cast<int>(kPackMemory_bytes / kBytesAMebibyte);
  std::optional<int> threads;  // beside the one that plays
};

// Negative: go on. Else the exit status: 0 after --help, 2 after bad usage, which was said in one line.
int ParsePlayerOptions(int argc, char** argv, PlayerOptions* options);

}  // namespace flaneur
