#include "pipeline/cli/life_settings.h"

#include "runtime/base/text.h"

namespace flaneur {
namespace {

void ReadFlock(TomlTable table, TourData* tour) {
  Flock flock;
  table.Text("avatar", &flock.avatar);
  table.Point("position_m", &flock.position_m);
  table.Number("radius_m", &flock.radius_m, 0.5, static_cast<double>(kMaxFlockRadius_m));
  table.Number("birds", &flock.birds, 1, kMaxBirds);
  table.Number("shy_m", &flock.shy_m, 0, static_cast<double>(kMaxShy_m));
  table.Text("clip", &flock.clip);
  if (!table.Has("position_m")) table.Refuse("a [[flock]] needs position_m = [x, y]");
  if (flock.avatar.empty()) table.Refuse("a [[flock]] needs the name of an [[avatar]]");
  if (flock.clip.empty() || flock.clip == "walk" || flock.clip == "idle" || flock.clip == "talk")
    table.Refuse("a [[flock]] flies by a clip of its own, not walk, idle or talk");
  int birds = flock.birds;
  for (const Flock& other : tour->flocks) birds += other.birds;
  if (birds > kMaxBirds) table.Refuse("all flocks together have more than " + std::to_string(kMaxBirds) + " birds");
  table.Finish();
  tour->flocks.push_back(std::move(flock));
}

}  // namespace

void ReadLifeSettings(TomlTable* root, TourData* tour) {
  for (TomlTable& flock : root->Tables("flock")) ReadFlock(flock, tour);
}

}  // namespace flaneur
