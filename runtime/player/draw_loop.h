// Plays a simulation with pictures: in a window in real time, or headless as fast as it goes.
#pragma once
#include <filesystem>

#include "runtime/base/error.h"
#include "runtime/pack/tour_pack.h"
#include "runtime/player/records.h"
#include "runtime/player/simulation.h"

namespace flaneur {

struct DrawOptions {
  int width_px = 1280, height_px = 720;
  double seconds = 0;                // simulated time; ends earlier when the scenario's last leg is over
  std::filesystem::path screenshot;  // PNG of the last picture; empty: none
  std::filesystem::path film;        // MP4 of all pictures, one a step; empty: none
};

// Draws and records one picture a step, the first one before any step; 0 seconds give this one alone.
// Errors: no EGL, no ffmpeg (films), an odd film size, a file that can't be written. Files appear whole or not at all.
Error PlayHeadless(const TourPack& pack, const DrawOptions& options, Simulation* simulation, Records* records);

// Until the window is closed, or for `seconds` where those are positive. WASD or arrow keys walk, the mouse looks, Tab or
// space changes between guided tour (or the scenario's legs) and free walk, Esc ends.
// Errors: no display, no OpenGL ES 3.0, the screenshot can't be written. Films are headless only.
Error PlayWindow(const TourPack& pack, const DrawOptions& options, Simulation* simulation, Records* records);

}  // namespace flaneur
