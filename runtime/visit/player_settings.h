// How this visitor likes to walk and look: keys, comfort, language. One file a user, player.toml.
#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "runtime/base/error.h"

namespace flaneur {

// In the order of kActionNames.
enum class Action {
  kWalkAhead,
  kWalkBack,
  kWalkLeft,
  kWalkRight,
  kTurnLeft,
  kTurnRight,
  kLookUp,
  kLookDown,
  kTour,
  kPause,
  kNext,
  kBack,
  kLanguage,
  kPointer,
  kWider,
  kNarrower,
  kViews,
  kAdaptation,
  kFullscreen,
  kMap,
  kPhoto,
  kAsk,
  kMenu,
  kQuit,
  kCount
};
inline constexpr size_t kActions = static_cast<size_t>(Action::kCount);
inline constexpr const char* kActionNames[kActions] = {
    "walk_ahead", "walk_back",  "walk_left",  "walk_right", "turn_left", "turn_right", "look_up", "look_down",
    "tour",       "pause",      "next",       "back",       "language",  "pointer",    "wider",   "narrower",
    "views",      "adaptation", "fullscreen", "map",        "photo",     "ask",        "menu",    "quit"};

struct PlayerSettings {
  std::string language;  // of the guided tour; empty: the tour's own
  std::string pointer =
      "look";  // look: the mouse turns the view; point: drag to turn, click to walk there (touch screens)
  float walk_speed_mps = 1.5f;
  float turn_speed_dps = 90;  // by keys and gamepad
  float mouse_speed = 1;
  float field_of_view_deg = 0;  // horizontal; 0: the tour's own
  float snap_turn_deg = 0;      // turns by keys and gamepad go so far at once; 0: smoothly
  bool invert_look = false;
  std::string text_size = "normal";     // of pages and captions: normal, large or largest
  bool high_contrast = false;           // pages and captions opaque, in white and yellow on black
  bool captions_always = false;         // nothing takes a caption's place
  float pace = 1;                       // of the visitor and of the tour; 1: as they are
  float eye_height_m = 0;               // above the ground, 1.2 as if seated; 0: standing, as the tour has it
  std::string one_handed = "off";       // left_keys, right_keys, left_pad, right_pad: that half alone does everything
  bool reduced_motion = false;          // the tour turns the view gently and walks slowly, nothing fades
  float sound_volume = 1;               // of what is spoken; 1: as recorded
  float frames_per_s = 25;              // where a machine draws fewer, the window's picture is drawn more coarsely
  float least_resolution_scale = 0.5f;  // but not below this share of its width and height; 1: never
  std::string photos;  // folder where visitors' photos are kept; empty: in the user's pictures, in an exhibition none
  std::string photo_link;    // instead of the tour's, for the QR code: with {file} or {id}; empty: the tour's
  float photos_most = 1000;  // that are kept; of more the eldest are deleted
  bool fullscreen = false;   // the window fills its screen
  bool kiosk = false;        // for exhibitions: visitor after visitor, and only the operator ends it
  std::array<std::vector<std::string>, kActions> keys;

  PlayerSettings();  // with the default keys
};

// $XDG_CONFIG_HOME/flaneur/player.toml, else in ~/.config; empty where neither is known.
std::filesystem::path PlayerSettingsPath();

// What is wrong keeps its default, and is named with FILE:LINE in `warnings`. A file that is not there is all defaults.
// Errors: unreadable, not TOML.
Error ReadPlayerSettings(const std::filesystem::path& path, PlayerSettings* settings,
                         std::vector<std::string>* warnings);

// "walk_speed_mps=1.2" or "keys.pause=p,pad_x". Errors: no such setting (names the nearest), a value out of range.
Error SetPlayerSetting(const std::string& assignment, PlayerSettings* settings);

// Puts into `kept` what differs between `before` and `now`.
void KeepChanges(const PlayerSettings& before, const PlayerSettings& now, PlayerSettings* kept);

// The whole file, with a word about each setting.
std::string PlayerSettingsText(const PlayerSettings& settings);
// Makes the folder where it is missing.
Error WritePlayerSettings(const std::filesystem::path& path, const PlayerSettings& settings);

}  // namespace flaneur
