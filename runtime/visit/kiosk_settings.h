// How a museum sets up a kiosk: kiosk.toml, the operator's file. docs/kiosk.md explains it.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "runtime/base/error.h"

namespace flaneur {

struct KioskSettings {
  std::filesystem::path tour;               // that is played where the command line names none
  std::string pin;                          // digits that open the operator's page; empty: nothing does
  float idle_s = 90;                        // without a touch, a key or a click, until a visit is over
  std::vector<std::string> languages;       // that visitors can choose; the first is everybody's at first; empty: all
  std::string monitor;                      // its number or name; empty: the primary one
  std::string pointer = "point";            // PlayerSettings::pointer
  bool statistics = true;                   // one line a visit is kept
  std::filesystem::path statistics_folder;  // empty: $XDG_STATE_HOME/flaneur
  float hang_s = 5;                         // without a picture, until the player is started anew
};

inline constexpr size_t kLeastPinDigits = 4, kMostPinDigits = 12;

// The first that is there of $XDG_CONFIG_HOME/flaneur/kiosk.toml (else ~/.config/...) and /etc/flaneur/kiosk.toml;
// empty: neither is.
std::filesystem::path KioskSettingsPath();

// Errors: unreadable, not TOML, an unknown key (with the nearest known one), a wrong type or value; FILE:LINE in front.
Error ReadKioskSettings(const std::filesystem::path& path, KioskSettings* settings);

}  // namespace flaneur
