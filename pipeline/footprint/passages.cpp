#include "pipeline/footprint/passages.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pipeline/footprint/constants.h"

namespace flaneur {
namespace {

std::vector<const std::vector<Triangle3>*> TrianglesOf(const TownObjects& town) {
  std::vector<const std::vector<Triangle3>*> all;
  for (const TownObject& object : town.obstacles) all.push_back(&object.triangles);
  return all;
}

}  // namespace

PassageTest::PassageTest(const TownObjects& town, const GroundRaster& raster, const Options& options)
    : options_(options), ground_(raster), overhead_(TrianglesOf(town)) {}

bool PassageTest::Roofed(Point2 p) const { return overhead_.Covers(p, ground_.Height(p.x, p.y) + options_.headroom_m); }

// Walks both ways along lines through p, under the roof, until walls.
bool PassageTest::BetweenWalls(Point2 p, const AreaIndex& walls) const {
  const auto hits = [&](double angle) {
    for (double d = kPassageStep_m; d < kFarthestWall_m; d += kPassageStep_m) {
      const Point2 q{p.x + d * std::cos(angle), p.y + d * std::sin(angle)};
      if (walls.Inside(q)) return true;
      if (!Roofed(q)) return false;
    }
    return false;
  };
  for (int i = 0; i < kPassageDirections; ++i) {
    const double angle = 3.14159265358979323846 * i / kPassageDirections;
    if (hits(angle) && hits(angle + 3.14159265358979323846)) return true;
  }
  return false;
}

PassageTest::Samples PassageTest::Sample(const Rings& area, const Rings& walkable, double step_m) const {
  Samples samples;
  for (const Ring& ring : walkable)  // narrow ones may lie between the samples
    for (const Point2& p : ring)
      if (Roofed(p)) samples.candidates.push_back(p);
  const AreaIndex inside(area, step_m), walk(walkable, step_m);
  const BoundingBox box = BoundingBoxOf(area);
  for (double y = box.min.y + step_m / 2; y < box.max.y; y += step_m) {
    for (double x = box.min.x + step_m / 2; x < box.max.x; x += step_m) {
      const Point2 p{x, y};
      if (!inside.Inside(p)) continue;
      if (!Roofed(p)) {
        samples.open.push_back(p);
        continue;
      }
      samples.roofed.push_back(p);
      if (walk.Inside(p)) samples.candidates.push_back(p);
    }
  }
  return samples;
}

// Whether enough of the candidates have walls on two sides; the first that has.
std::optional<Point2> PassageTest::FirstBetweenWalls(const std::vector<Point2>& candidates,
                                                     const AreaIndex& walls) const {
  const size_t stride = std::max<size_t>(1, candidates.size() / kMaxAskedSamples);
  std::optional<Point2> first;
  int asked = 0, between = 0;
  for (size_t i = 0; i < candidates.size(); i += stride) {
    ++asked;
    if (!BetweenWalls(candidates[i], walls)) continue;
    if (between++ == 0) first = candidates[i];
  }
  return between < kMinWalledShare * asked ? std::nullopt : first;
}

PassageParts PassageTest::Sort(const Rings& area, const Rings& walls) const {
  const double whole_m2 = Area(area);
  PassageParts parts{0, whole_m2, {}, area[0][0]};
  const Rings walkable = Offset(area, -(options_.person_radius_m - options_.slack_m));
  if (walkable.empty()) return parts;
  const double step_m = std::max(kPassageStep_m, std::sqrt(whole_m2 / kMaxPassageSamples));
  Samples samples = Sample(area, walkable, step_m);
  const std::optional<Point2> passage_at = FirstBetweenWalls(samples.candidates, AreaIndex(walls, step_m));
  if (!passage_at) return parts;
  const double reach_m = options_.ends_m + step_m;
  std::erase_if(samples.open, [&](Point2 p) {
    return std::any_of(samples.roofed.begin(), samples.roofed.end(),
                       [&](Point2 q) { return std::hypot(p.x - q.x, p.y - q.y) < reach_m; });
  });
  parts.passage_m2 = static_cast<double>(samples.roofed.size()) * step_m * step_m;
  parts.elsewhere_m2 = static_cast<double>(samples.open.size()) * step_m * step_m;
  parts.passage_at = *passage_at;
  if (!samples.open.empty()) parts.elsewhere_at = samples.open[0];
  return parts;
}

}  // namespace flaneur
