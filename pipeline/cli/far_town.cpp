#include "pipeline/cli/far_town.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

constexpr double kStep_m = 100;

// x east, y north, z up.
bool Middle(const Scene& town, Point3* middle) {
  Point3 low, high;
  if (!ExtentOf(town, &low, &high)) return false;
  *middle = {(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2};
  return true;
}

void Subtract(double by, float* value) { *value = static_cast<float>(static_cast<double>(*value) - by); }

}  // namespace

Point2 FarFromZero(double far_m, double scale, const Scene& town) {
  Point3 middle;
  const double far = far_m / scale, step = kStep_m / scale;
  if (!Middle(town, &middle) || std::max(std::abs(middle.x), std::abs(middle.y)) <= far) return {};
  return {std::floor(middle.x / step) * step, std::floor(middle.y / step) * step};
}

void MoveNearZero(Point2 by, Scene* town) {
  for (SceneNode& node : town->nodes) {
    Subtract(by.x, &node.world.m[3][0]);
    Subtract(-by.y, &node.world.m[3][2]);  // glTF's +Z is south
  }
  town->origin_m = {town->origin_m.x + by.x, town->origin_m.y + by.y};
}

double LowerToZero(double far_m, Scene* town) {
  Point3 middle;
  if (!Middle(*town, &middle) || std::abs(middle.z) <= far_m) return 0;
  const double by = std::floor(middle.z / kStep_m) * kStep_m;
  for (SceneNode& node : town->nodes) Subtract(by, &node.world.m[3][1]);
  return by;
}

Error PlaceTown(const Georeference& wish, double far_m, double scale, Scene* town, Point2* moved,
                std::vector<std::string>* warnings) {
  Georeference georeference = wish;
  const Point2 own = town->origin_m, by = FarFromZero(far_m, scale, *town);
  MoveNearZero(by, town);
  if (moved) *moved = by;
  if (wish.origin_m.x != 0 || wish.origin_m.y != 0) {
    georeference.origin_m = {wish.origin_m.x + by.x * scale, wish.origin_m.y + by.y * scale};
    town->origin_m = own;
  }
  return SetGeoreference(georeference, scale, town, warnings);
}

Point2 InMovedTown(Point2 p, Point2 moved_m) {
  const Point2 there{p.x - moved_m.x, p.y - moved_m.y};
  return std::hypot(there.x, there.y) < std::hypot(p.x, p.y) ? there : p;
}

Vec2 InMovedTown(Vec2 p, Point2 moved_m) {
  const Point2 there = InMovedTown(Point2{static_cast<double>(p.x), static_cast<double>(p.y)}, moved_m);
  return {static_cast<float>(there.x), static_cast<float>(there.y)};
}

void TakeIntoMovedTown(Point2 moved_m, double lowered_m, TourData* tour) {
  const auto take = [&](Vec2* p) { *p = InMovedTown(*p, moved_m); };
  for (Place& place : tour->places) take(&place.position_m);
  for (TourStop& stop : tour->path) take(&stop.position_m);
  for (Hotspot& hotspot : tour->hotspots) take(&hotspot.position_m);
  for (SoundPlace& sound : tour->sound_places) take(&sound.position_m);
  for (Flock& flock : tour->flocks) take(&flock.position_m);
  for (Street& street : tour->streets)
    std::for_each(street.points.begin(), street.points.end(), [&](Vec2& p) { take(&p); });
  for (Smoke& smoke : tour->smokes) {
    const Vec2 p = InMovedTown(Vec2{smoke.position_m.x, smoke.position_m.y}, moved_m);
    const auto z = static_cast<double>(smoke.position_m.z), there = z - lowered_m;
    smoke.position_m = {p.x, p.y, static_cast<float>(std::abs(there) < std::abs(z) ? there : z)};
  }
}

PaintingSettings InMovedTown(PaintingSettings painting, Point2 moved_m) {
  for (std::optional<Vec2>* corner : {&painting.min_m, &painting.max_m})
    if (*corner) *corner = InMovedTown(**corner, moved_m);
  return painting;
}

std::vector<AcceptedFinding> InMovedTown(std::vector<AcceptedFinding> accepted, Point2 moved_m) {
  for (AcceptedFinding& a : accepted) a.at_m = InMovedTown(a.at_m, moved_m);
  return accepted;
}

}  // namespace flaneur
