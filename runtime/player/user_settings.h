// The user's settings file between start and end. Internal to runtime/player.
#pragma once
#include "runtime/player/options.h"
#include "runtime/player/player_settings.h"

namespace flaneur {

// A file with something wrong in it is used as far as it goes, and never written to.
struct UserSettings {
  std::filesystem::path path;
  PlayerSettings in_file, settings;  // settings: with what the command line says
  bool may_save = false;
};

// Warns of what is wrong in the file. Errors: an option that is no setting.
Error ReadUserSettings(const PlayerOptions& options, UserSettings* user);

// Errors: no folder for it, something wrong in the file that is there, and what WriteFile says.
Error SaveUserSettings(const PlayerSettings& settings, const UserSettings& user);

// Saves what differs from `settings`, and not what only the command line said. Nothing to save is no error.
Error SaveChanges(const PlayerSettings& now, UserSettings* user);

}  // namespace flaneur
