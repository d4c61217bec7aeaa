#include "pipeline/cli/life_settings.h"

#include "runtime/base/text.h"

namespace flaneur {
namespace {

constexpr double kMostPlace_m = 1e8;  // of a map

void ReadFlock(TomlTable table, TourData* tour) {
  Flock flock;
  table.Text("avatar", &flock.avatar);
  table.TownPoint("position_m", &flock.position_m);
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

void ReadSmoke(TomlTable table, TourData* tour) {
  Smoke smoke;
  std::vector<float> position_m;
  table.Numbers("position_m", &position_m, -kMostPlace_m, kMostPlace_m);
  table.Number("width_m", &smoke.width_m, kLeastSmoke_m, kMostSmoke_m);
  table.Number("density", &smoke.density, 0, 1);
  if (position_m.size() == 3) smoke.position_m = {position_m[0], position_m[1], position_m[2]};
  else table.Refuse("a [[smoke]] needs position_m = [x, y, z], z in the town's own height");
  if (tour->smokes.size() == kMaxSmokes) table.Refuse("more than " + std::to_string(kMaxSmokes) + " [[smoke]]");
  table.Finish();
  tour->smokes.push_back(smoke);
}

}  // namespace

void ReadLifeSettings(TomlTable* root, TourData* tour) {
  for (TomlTable& flock : root->Tables("flock")) ReadFlock(flock, tour);
  for (TomlTable& smoke : root->Tables("smoke")) ReadSmoke(smoke, tour);
}

}  // namespace flaneur
