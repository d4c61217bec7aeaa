#include "runtime/desktop/user_settings.h"

#include "runtime/desktop/warn.h"

namespace flaneur {
namespace {

// What a kiosk has otherwise than a window of one's own.
Error TakeKiosk(const PlayerOptions& options, UserSettings* user) {
  const auto path = options.kiosk_settings.empty() ? KioskSettingsPath() : options.kiosk_settings;
  if (!path.empty()) {
    if (Error e = ReadKioskSettings(path, &user->kiosk)) return e;
  }
  user->settings = user->in_file;
  user->settings.fullscreen = true;
  user->settings.pointer = user->kiosk.pointer;
  if (!user->kiosk.languages.empty()) user->settings.language = user->kiosk.languages.front();
  return TakeOptions(options, &user->settings);
}

}  // namespace

Error TakeOptions(const PlayerOptions& options, PlayerSettings* settings) {
  for (const std::string& assignment : options.set) {
    if (Error e = SetPlayerSetting(assignment, settings)) return Fail("--set: " + e.message);
  }
  if (!options.photos.empty()) settings->photos = options.photos.string();
  if (options.fullscreen) settings->fullscreen = true;
  if (options.kiosk) settings->kiosk = true;
  if (options.language) settings->language = *options.language;
  return Ok();
}

Error ReadUserSettings(const PlayerOptions& options, UserSettings* user) {
  user->path = options.settings.empty() ? PlayerSettingsPath() : options.settings;
  std::vector<std::string> wrong;
  if (Error e = ReadPlayerSettings(user->path, &user->in_file, &wrong)) wrong = {e.message};
  user->settings = user->in_file;
  user->may_save = wrong.empty() && !user->path.empty();
  if (!wrong.empty()) {
    const std::string more = wrong.size() > 1 ? " (and " + std::to_string(wrong.size() - 1) + " more)" : "";
    Warn(wrong.front() + more + "; the default is used, and the file stays as it is");
  }
  if (Error e = TakeOptions(options, &user->settings)) return e;
  return user->settings.kiosk ? TakeKiosk(options, user) : Ok();
}

Error SaveUserSettings(const PlayerSettings& settings, const UserSettings& user) {
  if (user.may_save) return WritePlayerSettings(user.path, settings);
  return user.path.empty()
             ? Fail(
                   "there is no folder for settings: neither XDG_CONFIG_HOME nor HOME is set; name a file with "
                   "--settings")
             : Fail(user.path.string() + ": has something wrong in it, so nothing is saved over it; mend or remove it");
}

Error SaveChanges(const PlayerSettings& now, UserSettings* user) {
  PlayerSettings kept = user->in_file;
  KeepChanges(user->settings, now, &kept);
  if (PlayerSettingsText(kept) == PlayerSettingsText(user->in_file)) return Ok();
  if (Error e = SaveUserSettings(kept, *user)) return e;
  user->in_file = kept;
  user->settings = now;
  return Ok();
}

}  // namespace flaneur
