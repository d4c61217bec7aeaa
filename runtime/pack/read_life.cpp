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

Smoke ReadSmoke(const TourObject& json) {
  const std::vector<float> p = json.Reals("position_m", -TourObject::kAnything, TourObject::kAnything);
  if (p.size() != 3) json.Refuse("has no position_m of three numbers");
  return {{p[0], p[1], p[2]}, json.Real("width_m", kLeastSmoke_m, kMostSmoke_m), json.Real("density", 0, 1)};
}

void ReadFlocks(const TourObject& tour, TourData* data) {
  int birds = 0;
  for (const TourObject& json : tour.Objects("flocks")) {
    data->flocks.push_back(ReadFlock(json));
    birds += data->flocks.back().birds;
    if (birds > kMaxBirds) json.Refuse("makes more birds than a tour may have");
  }
}

}  // namespace

void ReadLife(const TourObject& tour, TourData* data) {
  if (tour.Has("flocks")) ReadFlocks(tour, data);
  if (tour.Has("wind")) VisitFields(tour.Object("wind"), &data->wind);
  if (!tour.Has("smokes")) return;
  const std::vector<TourObject> smokes = tour.Objects("smokes");
  if (smokes.size() > kMaxSmokes) tour.Refuse("has more smokes than a tour may have");
  for (const TourObject& json : smokes) data->smokes.push_back(ReadSmoke(json));
}

}  // namespace flaneur
