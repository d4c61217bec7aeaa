// Stills of a run, each at its moment. Internal to runtime/desktop.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "runtime/desktop/options.h"

namespace flaneur {

struct Still {
  int64_t frame = -1;  // -1: the last one
  std::filesystem::path path;
};

// In the order of their frames: those that --screenshot and --at ask for. With --at each bears its moment, as
// walk_12.5s.png.
std::vector<Still> StillsOf(const PlayerOptions& options, float step_s);

}  // namespace flaneur
