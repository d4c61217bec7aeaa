#include "runtime/visit/kiosk_settings.h"

#include <algorithm>

#include "runtime/base/toml_table.h"
#include "runtime/visit/player_settings.h"

namespace flaneur {
namespace {

constexpr const char* kForAll = "/etc/flaneur/kiosk.toml";

bool IsPin(const std::string& pin) {
  return pin.size() >= kLeastPinDigits && pin.size() <= kMostPinDigits &&
         std::all_of(pin.begin(), pin.end(), [](char c) { return c >= '0' && c <= '9'; });
}

void ReadAll(TomlTable t, KioskSettings* s) {
  std::string pin = s->pin;
  t.File("tour", &s->tour);
  t.Text("pin", &pin);
  if (!pin.empty() && !IsPin(pin)) t.Refuse("pin must be 4 to 12 digits in quotes, such as \"4711\"");
  s->pin = pin;
  t.Number("idle_s", &s->idle_s, 10, 3600);
  t.Texts("languages", &s->languages);
  t.Text("monitor", &s->monitor);
  t.Choice("pointer", &s->pointer, {"point", "look"});
  t.Flag("statistics", &s->statistics);
  t.File("statistics_folder", &s->statistics_folder);
  t.Number("hang_s", &s->hang_s, 2, 60);
  t.Finish();
}

}  // namespace

std::filesystem::path KioskSettingsPath() {
  const std::filesystem::path own =
      PlayerSettingsPath().empty() ? std::filesystem::path() : PlayerSettingsPath().parent_path() / "kiosk.toml";
  std::error_code ec;
  for (const std::filesystem::path& path : {own, std::filesystem::path(kForAll)}) {
    if (!path.empty() && std::filesystem::exists(path, ec)) return path;
  }
  return {};
}

Error ReadKioskSettings(const std::filesystem::path& path, KioskSettings* settings) {
  toml::table root;
  if (Error e = ReadToml(path, &root)) return e;
  TomlContext context{path, {}, {}, {}};
  KioskSettings read = *settings;
  ReadAll(TomlTable(&context, &root, ""), &read);
  if (context.error) return context.error;
  *settings = std::move(read);
  return Ok();
}

}  // namespace flaneur
