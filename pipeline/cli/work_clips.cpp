#include "pipeline/cli/work_clips.h"

#include <algorithm>
#include <map>
#include <utility>

#include "pipeline/core/listed.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

bool IsUsual(const std::string& clip) { return clip.empty() || clip == "walk" || clip == "idle" || clip == "talk"; }

bool Holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// In the order of the flocks and places.
std::vector<std::string> ClipsFor(const std::string& avatar, const std::vector<Place>& places,
                                  const std::vector<Flock>& flocks) {
  std::vector<std::string> clips;
  for (const Flock& flock : flocks) {
    if (flock.avatar == avatar && !Holds(clips, flock.clip)) clips.push_back(flock.clip);
  }
  for (const Place& place : places) {
    if ((place.kind != "work" && place.kind != "play") || IsUsual(place.clip) || Holds(clips, place.clip)) continue;
    if (place.avatars.empty() || Holds(place.avatars, avatar)) clips.push_back(place.clip);
  }
  return clips;
}

bool Does(const TourAvatar& avatar, const Place& place) {
  const std::vector<Clip>& clips = avatar.levels.avatar.clips;
  const auto has = [&](const auto& clip) { return clip.name == place.clip; };
  if (std::none_of(clips.begin(), clips.end(), has)) return false;
  return place.kind != "play" || std::any_of(avatar.clips.begin(), avatar.clips.end(),
                                             [&](const TourClip& clip) { return has(clip) && clip.speed_mps > 0; });
}

bool MayBeAt(const TourAvatar& avatar, const Place& place) {
  return place.avatars.empty() ? avatar.share > 0 : Holds(place.avatars, avatar.levels.avatar.name);
}

}  // namespace

std::vector<std::string> WarningsOfWork(const TourParts& tour) {
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> places;  // by kind and clip
  for (const Place& place : tour.places) {
    if ((place.kind != "work" && place.kind != "play") || IsUsual(place.clip)) continue;
    const auto able = [&](const TourAvatar& a) { return MayBeAt(a, place) && Does(a, place); };
    if (std::any_of(tour.avatars.begin(), tour.avatars.end(), able)) continue;
    places[{place.kind, place.clip}].push_back(OneLine(place.name));
  }
  std::vector<std::string> warnings;
  for (const auto& [asked, names] : places) {
    const auto& [kind, clip] = asked;
    warnings.push_back("nobody can " + kind + " at " + Listed(names, names.size(), "'") +
                       ": no avatar that may be there has the clip '" + OneLine(clip) + "'" +
                       (kind == "play" ? " with a speed_mps" : "") + "; give one an [[avatar.clip]] of that name");
  }
  return warnings;
}

Error ChooseWorkClips(const std::vector<Place>& places, const std::vector<Flock>& flocks,
                      std::vector<AvatarSettings>* avatars, std::vector<std::string>* warnings) {
  std::vector<std::string> names;
  for (AvatarSettings& avatar : *avatars) {
    names.push_back(avatar.name);
    std::vector<ClipSettings> used;
    for (const std::string& name : ClipsFor(avatar.name, places, flocks)) {
      const auto known =
          std::find_if(avatar.clips.begin(), avatar.clips.end(), [&](const auto& clip) { return clip.name == name; });
      used.push_back(known != avatar.clips.end() ? *known : ClipSettings{name, "", 0, 0, {}});
    }
    if (used.size() > kMaxOtherClips) {
      return Fail("avatar '" + avatar.name + "' would need " + std::to_string(used.size()) +
                  " clips for the places of work; " + std::to_string(kMaxOtherClips) +
                  " are possible: name the avatars of some places");
    }
    avatar.clips = std::move(used);
  }
  for (const Place& place : places) {
    for (const std::string& name : place.avatars) {
      if (Holds(names, name)) continue;
      warnings->push_back("place '" + OneLine(place.name) + "': there is no avatar '" + OneLine(name) + "'");
      names.push_back(name);  // once is enough
    }
  }
  return Ok();
}

}  // namespace flaneur
