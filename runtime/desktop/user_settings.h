// The user's settings file between start and end, and a kiosk's. Internal to runtime/desktop.
#pragma once
#include "runtime/desktop/options.h"
#include "runtime/visit/kiosk_settings.h"
#include "runtime/visit/player_settings.h"
#include "runtime/visit/shell.h"

namespace flaneur {

// A file with something wrong in it is used as far as it goes, and never written to.
struct UserSettings {
  std::filesystem::path path;
  PlayerSettings in_file, settings;  // settings: with what the command line says
  bool may_save = false;
  KioskSettings kiosk;  // where settings.kiosk
};

// What the command line alone says, over `settings`: for runs without a window, which give the same for everybody.
// Errors: an option that is no setting.
Error TakeOptions(const PlayerOptions& options, PlayerSettings* settings);

// Warns of what is wrong in the file. Errors: an option that is no setting, something wrong in the kiosk's file.
Error ReadUserSettings(const PlayerOptions& options, UserSettings* user);

// Errors: no folder for it, something wrong in the file that is there, and what WriteFile says.
Error SaveUserSettings(const PlayerSettings& settings, const UserSettings& user);

// Saves what differs from `settings`, and not what only the command line said. Nothing to save is no error.
Error SaveChanges(const PlayerSettings& now, UserSettings* user);

// For a visit; the file's struct outlives it.
class UserSettingsStore : public SettingsStore {
 public:
  explicit UserSettingsStore(UserSettings* user) : user_(user) {}
  Error Save(const PlayerSettings& now) override { return SaveChanges(now, user_); }

 private:
  UserSettings* user_;
};

}  // namespace flaneur
