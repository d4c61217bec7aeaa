// A tour gets ready: its pack is opened, and a simulation of it begun. Internal to runtime/desktop.
#pragma once
#include <vector>

#include "runtime/base/error.h"
#include "runtime/desktop/options.h"
#include "runtime/pack/tour_pack.h"
#include "runtime/simulation/simulation.h"
#include "runtime/visit/loading.h"

namespace flaneur {

struct StartingTour {
  explicit StartingTour(const PlayerOptions& options);

  Jobs jobs;  // outlive the rest
  TourPack pack;
  PackFile file;
  Scenario scenario;
  Loader loader;
  std::vector<Simulation> simulations;  // as many as options.compare names, one at least
};

// The pack, where options names one, and the scenario.
Error OpenTour(const PlayerOptions& options, StartingTour* tour);
// After it. `loader` may have been started meanwhile.
Error StartSimulations(const PlayerOptions& options, StartingTour* tour);
// What was noticed on the way.
void WarnOfTour(const StartingTour& tour);

}  // namespace flaneur
