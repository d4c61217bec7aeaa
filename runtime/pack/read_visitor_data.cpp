#include "runtime/pack/read_visitor_data.h"

#include <algorithm>
#include <iterator>

#include "runtime/base/array.h"
#include "runtime/base/limits.h"
#include "runtime/pack/allowance.h"

namespace flaneur {
namespace {

constexpr double kMaxHeight_m = 500, kMaxRadius_m = 1000;

// A file in the pack: the number of one of `files`, where all who name the same bytes find them.
int AddFile(const GltfFile& file, const TourObject& json, const char* key, std::vector<std::vector<uint8_t>>* files,
            std::vector<ByteRange>* ranges) {
  const int view = json.View(key, Member(file.json, "bufferViews").size());
  const ByteRange range = RangeOfView(file, view);
  file.allowance->TakeWork(ranges->size(), "a sound or picture");
  const auto same = std::find(ranges->begin(), ranges->end(), range);
  if (same != ranges->end()) return static_cast<int>(same - ranges->begin());
  file.allowance->TakeMemory(range.bytes, "a sound or picture");
  ranges->push_back(range);
  const bool there = !file.there || file.there->Holds(ranges->back());
  const auto bytes = there ? BufferView(file, view) : std::span<const uint8_t>();
  files->emplace_back(bytes.begin(), bytes.end());
  return Count(*files) - 1;
}

Hotspot ReadHotspot(const GltfFile& file, const TourObject& json, TourPack* pack) {
  Hotspot hotspot{json.Point("position_m"), json.Real("height_m", -kMaxHeight_m, kMaxHeight_m),
                  json.Real("radius_m", TourObject::kAboveZero, kMaxRadius_m)};
  hotspot.titles = ReadTranslations(json, "titles");
  hotspot.texts = ReadTranslations(json, "texts");
  hotspot.sounds = ReadSounds(file, json, pack);
  if (!json.Has("picture_view")) return hotspot;
  hotspot.picture = AddFile(file, json, "picture_view", &pack->pictures, &pack->picture_ranges);
  return hotspot;
}

SoundPlace ReadSoundPlace(const GltfFile& file, const TourObject& json, TourPack* pack) {
  SoundPlace place;
  const std::string kind = json.OneOf("kind", {"steps", "murmur", "water", "birds", "bell", "loop"});
  const auto* const found = std::find(std::begin(kSoundKindNames), std::end(kSoundKindNames), kind);
  place.kind = static_cast<SoundKind>(found - std::begin(kSoundKindNames));
  place.position_m = json.Point("position_m");
  place.height_m = json.Real("height_m", -kMaxHeight_m, kMaxHeight_m);
  place.radius_m = json.Real("radius_m", TourObject::kAboveZero, kMaxRadius_m);
  place.volume = json.Real("volume", 0, 4);
  if (json.Has("view")) {
    place.sound = AddFile(file, json, "view", &pack->sounds, &pack->sound_ranges);
  } else if (place.kind == SoundKind::kLoop) {
    json.Refuse("is a loop without a view of its sound");
  }
  return place;
}

std::vector<Vec2> ReadLine(const TourObject& json) {
  std::vector<Vec2> points = json.Points("points_m");
  if (points.size() < 2) json.Refuse("needs two points at least");
  return points;
}

}  // namespace

TextsByLanguage ReadTranslations(const TourObject& json, const char* key) {
  TextsByLanguage texts;
  if (!json.Has(key)) return texts;
  const TourObject object = json.Object(key);
  for (const std::string& language : object.Keys()) texts[language] = object.Text(language.c_str(), kMostText_bytes);
  return texts;
}

std::map<std::string, StopSound> ReadSounds(const GltfFile& file, const TourObject& json, TourPack* pack) {
  std::map<std::string, StopSound> sounds;
  if (!json.Has("sounds")) return sounds;
  const TourObject object = json.Object("sounds");
  for (const std::string& language : object.Keys()) {
    const TourObject sound = object.Object(language.c_str());
    sounds[language] = {AddFile(file, sound, "view", &pack->sounds, &pack->sound_ranges),
                        sound.Real("duration_s", 0, kMostPause_s)};
  }
  return sounds;
}

void ReadVisitorData(const GltfFile& file, const TourObject& tour, TourPack* pack) {
  if (tour.Has("hotspots")) {
    for (const TourObject& h : tour.Objects("hotspots", kMostHotspots))
      pack->hotspots.push_back(ReadHotspot(file, h, pack));
  }
  if (tour.Has("streets")) {
    for (const TourObject& s : tour.Objects("streets", kMostStreets))
      pack->streets.push_back({ReadTranslations(s, "names"), ReadLine(s)});
  }
  if (tour.Has("sounds")) {
    for (const TourObject& p : tour.Objects("sounds", kMostSounds))
      pack->sound_places.push_back(ReadSoundPlace(file, p, pack));
  }
  if (!tour.Has("photo")) return;
  const TourObject photo = tour.Object("photo");
  pack->photo.lines = ReadTranslations(photo, "lines");
  if (photo.Has("link")) pack->photo.link = photo.Text("link");
}

}  // namespace flaneur
