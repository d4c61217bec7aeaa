// What a visitor's settings mean for the town they walk through, whatever shows it.
#pragma once
#include <string>

#include "runtime/simulation/simulation.h"
#include "runtime/visit/player_settings.h"

namespace flaneur {

// As the tour has it, where the settings say nothing.
struct OwnView {
  float fov_rad = 0, eye_m = kEyeHeight_m;
};

// Of the tour's languages the settings' own, else the tour's first.
std::string SpokenLanguage(const PlayerSettings& settings, const GuidedTour& tour);
// Comfort, view and language; now and whenever they change.
void HeedSettings(const PlayerSettings& settings, const OwnView& own, Simulation* simulation);

}  // namespace flaneur
