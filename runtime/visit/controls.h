// From keys, mouse, gamepad and taps to what the visitor wants.
#pragma once
#include <array>
#include <bitset>
#include <vector>

#include "runtime/simulation/simulation.h"
#include "runtime/visit/player_settings.h"
#include "runtime/visit/window_input.h"

namespace flaneur {

// The settings' keys by number, and what has been asked for so far.
struct Controls {
  PlayerSettings settings;
  KeyLayout layout;
  std::vector<std::string> offered_languages;  // by a kiosk; empty: all that there are
  std::array<std::vector<int>, kActions> codes;
  std::bitset<kActions> was_down;
  bool follows_tour = true;             // else the visitor walks about
  bool points = false;                  // the pointer is free: drag to turn, click to walk there
  bool quits = false, changed = false;  // changed: the settings, to be saved
  bool toggles_views = false, switches_adaptation = false, opens_pages = false;  // taken once
  bool opens_map = false, takes_photo = false, asks = false;                     // likewise
  bool has_photos = false;                                                       // they are kept somewhere
  bool acted = false;                      // the visitor has walked, turned or clicked by now
  bool applies = false;                    // changed settings have still to be heeded
  float to_turn_rad = 0, to_look_rad = 0;  // that the mouse or a snap asked for, and the simulation has still to do
  float turned_rad = 0;                    // of it, what the last picture's steps did
  float turn_radps = 0;                    // of keys and sticks
  bool snap_ready = true;                  // since a turning key or stick was let go
};

Controls MakeControls(const PlayerSettings& settings, const KeyLayout& layout, const Simulation& simulation);

// The codes anew, after the settings' keys or the hand they are for have changed.
void TakeKeys(Controls* controls);
// The key or button becomes the action's only one of its kind, keyboard or gamepad, and nobody else's. False, and
// nothing done, where it has no name or opens the pages.
bool Rebind(Action action, int code, Controls* controls);
// The keys as they were delivered.
void ResetKeys(Controls* controls);

// What the hands did since the last picture, passed_s ago. aspect: of the picture, width over height. pages: a page is
// open, and all but ending is meant for it.
void TakeInput(const WindowInput& input, float passed_s, float aspect, bool pages, const Simulation& simulation,
               Controls* controls, CameraInput* camera);

// For the next step. Wishes are fulfilled once; turned_rad grows by what the step will do.
CameraInput NextStep(const CameraInput& camera, const Simulation& simulation, Controls* controls);

// What a picture can show already of what the mouse or a snap asked for, a share of a step after the last one: as much
// as the next step will do of it by then. Looking up and down needs no readiness of anybody and is done whole.
float TurnUntil(float share, const Simulation& simulation, const Controls& controls);
float LookUntilNow(const Simulation& simulation, const Controls& controls);

}  // namespace flaneur
