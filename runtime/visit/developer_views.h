// Views for the curious: a live plan of the town with both view volumes, zones, obstacles and people coloured by class
// (the paper's Figs. 3, 4, 8 and 12), graphs of the last while, and a switch of the adaptation.
#pragma once
#include <array>

#include "runtime/render/frame.h"
#include "runtime/simulation/simulation.h"

namespace flaneur {

// The last frames, oldest at `next`.
struct ViewsHistory {
  static constexpr size_t kFrames = 300;
  std::array<float, kFrames> high{}, triangles{}, frame_ms{};
  size_t next = 0;
};

struct DeveloperViews {
  bool shown = false;
  float half_width_m = 45;  // of the plan
  ViewsHistory history;
};

void RememberFrame(const Simulation& simulation, const FrameStatistics& statistics, float frame_ms,
                   ViewsHistory* history);

// Off to paper to full and round again.
void SwitchAdaptation(Simulation* simulation);

// Between an Overlay's Begin and Draw.
void ShowViews(const FrameStatistics& statistics, int width_px, int height_px, DeveloperViews* views,
               Simulation* simulation);

}  // namespace flaneur
