#include "pipeline/cli/trust.h"

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "pipeline/cli/stage_inputs.h"
#include "pipeline/core/blender.h"
#include "pipeline/core/child_policy.h"
#include "pipeline/core/uri.h"
#include "runtime/base/file.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

fs::path FolderOf(const fs::path& tour) {
  std::error_code ec;
  return fs::weakly_canonical(fs::absolute(tour, ec), ec).parent_path();
}

std::vector<fs::path> TrustedFolders() {
  std::vector<fs::path> folders;
  std::string text;
  if (TrustedFoldersFile().empty() || ReadTextFile(TrustedFoldersFile(), &text)) return folders;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty()) folders.emplace_back(line);
  }
  return folders;
}

bool IsTrusted(const fs::path& folder) {
  const std::vector<fs::path> trusted = TrustedFolders();
  return !trusted.empty() && LiesWithin(folder, trusted);
}

Error Remember(const fs::path& folder) {
  if (TrustedFoldersFile().empty()) return Fail("there is no home folder to remember that in; use --allow-scripts");
  std::string text;
  for (const fs::path& each : TrustedFolders()) text += each.string() + "\n";
  return WriteTextFile(TrustedFoldersFile(), text + folder.string() + "\n");
}

// Whether the user says yes. Where nobody can be asked: no.
bool Ask(const fs::path& tour, const fs::path& script, const fs::path& folder) {
  if (::isatty(STDIN_FILENO) == 0 || ::isatty(STDERR_FILENO) == 0) return false;
  std::fprintf(stderr, "%s runs the script %s, which can do what you can.\nTrust everything in %s from now on? [y/N] ",
               tour.c_str(), script.c_str(), folder.c_str());
  std::string answer;
  return std::getline(std::cin, answer) && (answer == "y" || answer == "Y" || answer == "yes");
}

bool IsOurs(const fs::path& file) { return LiesWithin(file, {BlenderScriptsFolder()}); }

std::vector<fs::path> FilesOf(const TourSettings& s) {
  std::vector<fs::path> files = MediaFiles(s);
  if (!s.town.file.empty()) files.push_back(s.town.file);
  for (const TownPart& part : s.parts) files.push_back(part.file);
  for (const AvatarSettings& avatar : s.avatars) {
    files.push_back(avatar.source.file);
    for (const fs::path& file : FilesBeside(avatar)) files.push_back(file);
  }
  return files;
}

// The JSON of a .gltf or .glb; broken ones are left to who reads them.
nlohmann::json JsonOf(const std::string& bytes) {
  constexpr size_t kJsonOffset = 20;
  std::string_view text(bytes);
  if (text.substr(0, 4) == "glTF" && text.size() > kJsonOffset) {
    uint32_t length = 0;
    std::memcpy(&length, text.data() + 12, sizeof length);
    text = text.substr(kJsonOffset, length);
  }
  if (NestsTooDeep(text)) return {};
  return nlohmann::json::parse(text, nullptr, false);
}

}  // namespace

Error CheckFilesOfModel(const fs::path& model) {
  std::string bytes;
  if (GetChildPolicy().roots.empty() || !(HasExtension(model, ".gltf") || HasExtension(model, ".glb"))) return Ok();
  if (Error e = ReadTextFile(model, &bytes)) return e;
  const nlohmann::json json = JsonOf(bytes);
  for (const char* list : {"buffers", "images"}) {
    if (!json.is_object() || !json.contains(list) || !json[list].is_array()) continue;
    for (const nlohmann::json& each : json[list]) {
      if (!each.is_object() || !each.contains("uri") || !each["uri"].is_string()) continue;
      const std::string uri = each["uri"];
      if (uri.rfind("data:", 0) == 0) continue;
      if (Error e = CheckWithinRoots(model.parent_path() / DecodedUri(uri)))
        return Fail(model.string() + " names " + e.message);
    }
  }
  return Ok();
}

fs::path TrustedFoldersFile() {
  const char* config = std::getenv("XDG_CONFIG_HOME");
  const char* home = std::getenv("HOME");
  if (config && config[0] == '/') return fs::path(config) / "flaneur" / "trusted_folders";
  return home && home[0] == '/' ? fs::path(home) / ".config" / "flaneur" / "trusted_folders" : fs::path();
}

Error CheckTrust(const fs::path& tour, const TourSettings& settings, const Trust& trust) {
  const fs::path folder = FolderOf(tour);
  bool trusted = IsTrusted(folder);
  for (const fs::path& file : FilesOf(settings)) {
    if (!IsScript(file) || trust.scripts || trusted || IsOurs(file)) continue;
    if (!Ask(tour, file, folder)) {
      return Fail(PlaceOfFile(settings, file) + file.string() +
                  " is a script, which could do whatever you can; where you trust it, allow it by --allow-scripts");
    }
    if (Error e = Remember(folder)) return e;
    trusted = true;
  }
  for (const fs::path& file : FilesOf(settings)) {
    if (trust.outside || trusted || IsOurs(file) || LiesWithin(file, {folder})) continue;
    return Fail(PlaceOfFile(settings, file) + file.string() +
                " lies outside the tour's folder; copy it there, or allow it by --allow-outside");
  }
  return Ok();
}

}  // namespace flaneur
