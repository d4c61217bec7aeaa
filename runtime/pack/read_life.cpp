#include "runtime/pack/read_life.h"

namespace flaneur {
namespace {

Flock ReadFlock(const TourObject& json) {
  Flock flock;
  flock.avatar = json.Text("avatar");
  flock.position_m = json.Point("position_m");
  flock.radius_m = json.Real("radius_m", TourObject::kAboveZero, kMaxFlockRadius_m);
  flock.birds = json.Whole("birds", 1, kMaxBirds);
  flock.shy_m = json.Real("shy_m", 0, kMaxShy_m);
  flock.clip = json.Text("clip");
  return flock;
}

}  // namespace

void ReadLife(const TourObject& tour, TourData* data) {
  if (!tour.Has("flocks")) return;
  int birds = 0;
  for (const TourObject& json : tour.Objects("flocks")) {
    data->flocks.push_back(ReadFlock(json));
    birds += data->flocks.back().birds;
    if (birds > kMaxBirds) json.Refuse("makes more birds than a tour may have");
  }
}

}  // namespace flaneur
