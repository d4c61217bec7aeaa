#include "pipeline/cli/visitor_media.h"

#include <span>
#include <string_view>

#include "pipeline/cli/speech.h"
#include "pipeline/cli/stage_cache.h"
#include "pipeline/core/fingerprint.h"
#include "pipeline/io/sound_file.h"
#include "pipeline/pictures/picture_files.h"
#include "runtime/base/array.h"
#include "runtime/base/file.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace fs = std::filesystem;
namespace {

struct Media {
  const TourSettings& settings;
  const Store& store;
  TourParts* parts;
  std::map<fs::path, StopSound> sounds;  // each file once
  std::map<fs::path, int> pictures;

  Error Sound(const fs::path& file, StopSound* out) {
    const auto [entry, fresh] = sounds.try_emplace(file, StopSound{Count(parts->sounds), 0});
    if (fresh) {
      parts->sounds.emplace_back();
      std::vector<uint8_t>& bytes = parts->sounds.back();
      if (Error e = ReadFile(file, &bytes)) return e;
      if (Error e = Duration(file, bytes, &entry->second.duration_s)) return e;
    }
    *out = entry->second;
    return Ok();
  }

  // To know it, all of the sound has to be decoded.
  Error Duration(const fs::path& file, std::span<const uint8_t> bytes, float* duration_s) {
    const std::string_view content(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::string key = Fingerprint().Add("duration").Add(SoundReaderVersion()).Add(content).Hex();
    StoreEntry entry;
    std::string kept;
    if (ReadEntry(store, key, &entry, &kept) && Unpacked(kept, duration_s)) return Ok();
    SoundFile sound;
    if (Error e = ReadSoundFile(file, &sound)) return e;
    *duration_s = sound.duration_s;
    entry = {};
    entry.step = "duration:" + OneLine(file.filename().string());
    entry.extension = ".kept";
    return PutEntry(store, key, entry, Packed(duration_s));
  }

  // Made once: what scales pictures takes longer to load than all the rest of this.
  Error Scaled(const fs::path& file, std::vector<uint8_t>* bytes) {
    std::string content;
    if (Error e = ReadTextFile(file, &content)) return e;
    const std::string key =
        Fingerprint().Add("picture").Add(PictureVersion()).Add(kMaxPictureSide_px).Add(content).Hex();
    StoreEntry entry;
    std::string kept;
    if (ReadEntry(store, key, &entry, &kept)) {
      bytes->assign(kept.begin(), kept.end());
      return Ok();
    }
    if (Error e = ScaledPicture(file, kMaxPictureSide_px, bytes)) return e;
    entry = {};
    entry.step = "picture:" + OneLine(file.filename().string());
    entry.extension = ".kept";
    return PutEntry(store, key, entry, std::string_view(reinterpret_cast<const char*>(bytes->data()), bytes->size()));
  }

  Error Picture(const fs::path& file, int* out) {
    const auto [entry, fresh] = pictures.try_emplace(file, Count(parts->pictures));
    if (fresh) {
      parts->pictures.emplace_back();
      if (Error e = Scaled(file, &parts->pictures.back())) return e;
    }
    *out = entry->second;
    return Ok();
  }

  // What is recorded, and of the texts in other languages what a machine says.
  Error Sounds(FilesByLanguage files, bool speak, const TextsByLanguage& texts, std::map<std::string, StopSound>* out) {
    const SpeechSettings& speech = settings.visitor_files.speech;
    for (const auto& [language, text] : texts) {
      if (!speak || text.empty() || files.contains(language)) continue;
      const auto voice = speech.voices.find(language);
      fs::path file;
      if (Error e = Speak({text, voice == speech.voices.end() ? language : voice->second, speech.words_per_minute},
                          store, &file))
        return Fail("'" + OneLine(Beginning(text, 40)) + "' cannot be spoken: " + e.message);
      files[language] = file;
    }
    for (const auto& [language, file] : files) {
      if (Error e = Sound(file, &(*out)[language])) return e;
    }
    return Ok();
  }
};

Error MakeStops(Media* media) {
  const TourSettings& s = media->settings;
  for (size_t k = 0; k < s.path.size(); ++k) {
    TextsByLanguage texts = s.path[k].captions;
    if (!s.path[k].caption.empty()) texts[s.language] = s.path[k].caption;
    if (Error e = media->Sounds(s.sounds[k], s.visitor_files.stops_speak[k], texts, &media->parts->path[k].sounds))
      return e;
  }
  return Ok();
}

Error MakeHotspots(Media* media) {
  const TourSettings& s = media->settings;
  for (size_t k = 0; k < s.hotspots.size(); ++k) {
    const VisitorFiles::OfHotspot& files = s.visitor_files.hotspots[k];
    Hotspot* hotspot = &media->parts->hotspots[k];
    if (!files.picture.empty()) {
      if (Error e = media->Picture(files.picture, &hotspot->picture)) return e;
    }
    TextsByLanguage texts = s.hotspots[k].titles;
    for (const auto& [language, text] : s.hotspots[k].texts) {
      std::string& spoken = texts[language];
      spoken += (spoken.empty() ? "" : ". ") + text;
    }
    if (Error e = media->Sounds(files.sounds, files.speak, texts, &hotspot->sounds)) return e;
  }
  return Ok();
}

Error MakeSoundPlaces(Media* media) {
  const std::vector<fs::path>& files = media->settings.visitor_files.sound_places;
  for (size_t k = 0; k < files.size(); ++k) {
    if (files[k].empty()) continue;
    StopSound sound;
    if (Error e = media->Sound(files[k], &sound)) return e;
    media->parts->sound_places[k].sound = sound.sound;
  }
  return Ok();
}

}  // namespace

Error MakeVisitorMedia(const TourSettings& settings, const Store& store, TourParts* parts) {
  Media media{settings, store, parts, {}, {}};
  if (Error e = MakeStops(&media)) return e;
  if (Error e = MakeHotspots(&media)) return e;
  return MakeSoundPlaces(&media);
}

}  // namespace flaneur
