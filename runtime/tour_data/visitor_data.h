// What a town tells visitors besides its tour: things to look at, names of streets, sounds in their places, the photo's
// line. Structs alone; ground plane x east, y north, z up, metres.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "runtime/base/math.h"

namespace flaneur {

using TextsByLanguage = std::map<std::string, std::string>;

struct StopSound {
  int sound = 0;  // index into the tour's sounds
  float duration_s = 0;
};

// A thing that tells something to whoever looks at it.
struct Hotspot {
  Vec2 position_m;
  float height_m = 1.5f;  // over the ground there
  float radius_m = 12;    // from where one finds it
  TextsByLanguage titles = {}, texts = {};
  int picture = -1;  // index into the tour's pictures; -1: none
  std::map<std::string, StopSound> sounds = {};
};

struct Street {
  TextsByLanguage names;
  std::vector<Vec2> points;  // its middle line, two at least
};

// Steps and murmur come from the people, wherever they are; all others have a place.
enum class SoundKind { kSteps, kMurmur, kWater, kBirds, kBell, kLoop };
inline constexpr const char* kSoundKindNames[] = {"steps", "murmur", "water", "birds", "bell", "loop"};

struct SoundPlace {
  SoundKind kind = SoundKind::kLoop;
  Vec2 position_m;
  float height_m = 1.5f;
  float radius_m = 25;  // farther away it is not heard
  float volume = 1;
  int sound = -1;  // index into the tour's sounds; -1: the player's own of this kind, of which a loop has none
};

struct PhotoData {
  TextsByLanguage lines;  // under each picture
  std::string link;       // to where the operator shows it, with {file} or {id}; empty: nowhere
};

// The text in this language, else in `own`, else any; empty where there are none.
inline std::string TextIn(const TextsByLanguage& texts, const std::string& language, const std::string& own) {
  for (const std::string& wished : {language, own}) {
    if (const auto found = texts.find(wished); found != texts.end() && !found->second.empty()) return found->second;
  }
  return texts.empty() ? "" : texts.begin()->second;
}

}  // namespace flaneur
