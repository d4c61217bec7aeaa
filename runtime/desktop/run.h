// The ways to play: the simulation alone, into pictures, or in a window.
#pragma once
#include <vector>

#include "runtime/base/error.h"
#include "runtime/desktop/options.h"
#include "runtime/desktop/tour_start.h"
#include "runtime/desktop/user_settings.h"
#include "runtime/simulation/simulation.h"

namespace flaneur {

// How long a run lasts in simulated seconds; it also ends with the last leg or the tour's end.
float RunLength_s(const PlayerOptions& options, const Scenario& scenario, const Simulation& simulation);

Error RunWithoutDrawing(const PlayerOptions& options, float seconds, Simulation* simulation);
// Opens `tour`, which must name a pack. Several simulations, as many as options.compare names, are drawn side by side;
// records are of the first. Of the settings eye height and what captions look like hold.
Error RunHeadless(const PlayerOptions& options, const PlayerSettings& settings, StartingTour* tour);
// `tour` has not been opened. Settings that the visitor changes are saved. starts_anew: so that the program is to be
// started again.
Error RunInWindow(const PlayerOptions& options, StartingTour* tour, UserSettings* user, bool* starts_anew);

}  // namespace flaneur
