// What tour.toml says to visitors besides the stops: hotspots, streets, sounds in their places, the photo's line, and
// who speaks. Internal to pipeline/cli.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "runtime/base/toml_table.h"
#include "runtime/tour_data/tour_data.h"

namespace flaneur {

using FilesByLanguage = std::map<std::string, std::filesystem::path>;

// Texts that have no sound file are spoken by espeak-ng.
struct SpeechSettings {
  std::map<std::string, std::string> voices;  // of espeak-ng, by language; none: the language's own
  int words_per_minute = 145;
};

// Beside TourData, whose hotspots and sound places these belong to one by one.
struct VisitorFiles {
  struct OfHotspot {
    std::filesystem::path picture;  // empty: none
    FilesByLanguage sounds;
    bool speak = false;
  };
  std::vector<OfHotspot> hotspots;
  std::vector<std::filesystem::path> sound_places;  // empty: the player's own sound of that kind
  std::vector<bool> stops_speak;
  SpeechSettings speech;
};

// The key's file, or files by language.
FilesByLanguage ReadFiles(const char* key, const std::string& own, TomlTable* table);

// [[hotspot]], [[street]], [[sound]], [photo] and [speech]. What is wrong is refused by the tables.
void ReadVisitorSettings(TomlTable* root, TourData* tour, VisitorFiles* files);

// All files that these name.
std::vector<std::filesystem::path> FilesOf(const VisitorFiles& files);

}  // namespace flaneur
