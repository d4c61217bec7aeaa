#include "pipeline/cli/visitor_settings.h"

#include <algorithm>
#include <iterator>

#include "runtime/base/text.h"

namespace flaneur {
namespace {

// Texts that may be missing altogether; else one is in the tour's own language.
void ReadTexts(const char* key, const std::string& own, TomlTable* table, TextsByLanguage* texts) {
  table->Translations(key, own, texts);
  std::erase_if(*texts, [](const auto& text) { return text.second.empty(); });
  if (!texts->empty() && !texts->contains(own))
    table->Refuse(std::string("the ") + key + " has no text in the tour's own language, '" + own + "'");
}

void ReadHotspot(TomlTable table, TourData* tour, VisitorFiles* files) {
  Hotspot hotspot;
  VisitorFiles::OfHotspot of;
  table.TownPoint("position_m", &hotspot.position_m);
  table.Number("height_m", &hotspot.height_m, -500, 500);
  table.Number("radius_m", &hotspot.radius_m, 0.5, 1000);
  ReadTexts("title", tour->language, &table, &hotspot.titles);
  ReadTexts("text", tour->language, &table, &hotspot.texts);
  table.File("picture", &of.picture);
  of.sounds = ReadFiles("sound", tour->language, &table);
  table.Flag("speak", &of.speak);
  if (!table.Has("position_m")) table.Refuse("a [[hotspot]] needs position_m = [x, y]");
  if (hotspot.titles.empty()) table.Refuse("a [[hotspot]] needs a title");
  table.Finish();
  tour->hotspots.push_back(std::move(hotspot));
  files->hotspots.push_back(std::move(of));
}

void ReadStreet(TomlTable table, TourData* tour) {
  Street street;
  ReadTexts("name", tour->language, &table, &street.names);
  table.TownPoints("points_m", &street.points);
  if (street.names.empty()) table.Refuse("a [[street]] needs a name");
  if (street.points.size() < 2) table.Refuse("a [[street]] needs points_m = [[x, y], [x, y], ...], two at least");
  table.Finish();
  tour->streets.push_back(std::move(street));
}

void ReadSoundPlace(TomlTable table, TourData* tour, VisitorFiles* files) {
  SoundPlace place;
  std::filesystem::path file;
  std::string kind = kSoundKindNames[static_cast<size_t>(place.kind)];
  table.Choice("kind", &kind, {"steps", "murmur", "water", "birds", "bell", "loop"});
  const auto* const found = std::find(std::begin(kSoundKindNames), std::end(kSoundKindNames), kind);
  if (found != std::end(kSoundKindNames)) place.kind = static_cast<SoundKind>(found - std::begin(kSoundKindNames));
  table.File("file", &file);
  table.TownPoint("position_m", &place.position_m);
  table.Number("height_m", &place.height_m, -500, 500);
  table.Number("radius_m", &place.radius_m, 0.5, 1000);
  table.Number("volume", &place.volume, 0, 4);
  const bool is_of_people = place.kind == SoundKind::kSteps || place.kind == SoundKind::kMurmur;
  if (!is_of_people && !table.Has("position_m")) table.Refuse("a [[sound]] needs position_m = [x, y]");
  if (place.kind == SoundKind::kLoop && file.empty()) table.Refuse("a [[sound]] of kind \"loop\" needs a file");
  table.Finish();
  tour->sound_places.push_back(place);
  files->sound_places.push_back(std::move(file));
}

void ReadPhoto(TomlTable table, TourData* tour) {
  ReadTexts("line", tour->language, &table, &tour->photo.lines);
  table.Text("link", &tour->photo.link);
  const std::string& link = tour->photo.link;
  if (!link.empty() && link.find("{file}") == std::string::npos && link.find("{id}") == std::string::npos)
    table.Refuse("photo.link is the same for all photos; put {file} or {id} where a photo's name belongs");
  if (link.size() > 500) table.Refuse("photo.link is longer than 500 letters, too much for a QR code that phones read");
  table.Finish();
}

void ReadSpeech(TomlTable table, const std::string& own, SpeechSettings* speech) {
  table.Translations("voice", own, &speech->voices);
  table.Number("words_per_minute", &speech->words_per_minute, 80, 450);
  table.Finish();
}

}  // namespace

FilesByLanguage ReadFiles(const char* key, const std::string& own, TomlTable* table) {
  std::map<std::string, std::string> names;
  table->Translations(key, own, &names);
  FilesByLanguage files;
  for (const auto& [language, file] : names) {
    if (!file.empty()) files[language] = table->Beside(key, file);
  }
  return files;
}

void ReadVisitorSettings(TomlTable* root, TourData* tour, VisitorFiles* files) {
  for (TomlTable& hotspot : root->Tables("hotspot")) ReadHotspot(hotspot, tour, files);
  for (TomlTable& street : root->Tables("street")) ReadStreet(street, tour);
  for (TomlTable& sound : root->Tables("sound")) ReadSoundPlace(sound, tour, files);
  ReadPhoto(root->Table("photo"), tour);
  ReadSpeech(root->Table("speech"), tour->language, &files->speech);
}

std::vector<std::filesystem::path> FilesOf(const VisitorFiles& files) {
  std::vector<std::filesystem::path> all;
  const auto add = [&](const std::filesystem::path& file) {
    if (!file.empty()) all.push_back(file);
  };
  for (const VisitorFiles::OfHotspot& hotspot : files.hotspots) {
    add(hotspot.picture);
    for (const auto& [language, file] : hotspot.sounds) add(file);
  }
  for (const std::filesystem::path& file : files.sound_places) add(file);
  return all;
}

}  // namespace flaneur
