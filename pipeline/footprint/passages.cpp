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

PassageParts PassageTest::Sort(const Rings& area, const Rings& walls) const {
  PassageParts parts;
  const double whole = Area(area);
  parts.elsewhere_m2 = whole, parts.elsewhere_at = area[0][0];
  const Rings walkable = Offset(area, -(options_.person_radius_m - options_.slack_m));
  if (walkable.empty()) return parts;
  const double step = std::max(kPassageStep_m, std::sqrt(whole / kMaxPassageSamples));
  Point2 min{1e300, 1e300}, max{-1e300, -1e300};
  for (const Ring& ring : area) {
    for (const Point2& p : ring) {
      min = {std::min(min.x, p.x), std::min(min.y, p.y)};
      max = {std::max(max.x, p.x), std::max(max.y, p.y)};
    }
  }
  const AreaIndex inside(area, step), walk(walkable, step), solid(walls, step);
  std::vector<Point2> roofed, candidates, open;
  for (const Ring& ring : walkable)  // narrow ones may lie between the samples
    for (const Point2& p : ring)
      if (Roofed(p)) candidates.push_back(p);
  for (double y = min.y + step / 2; y < max.y; y += step) {
    for (double x = min.x + step / 2; x < max.x; x += step) {
      const Point2 p{x, y};
      if (!inside.Inside(p)) continue;
      if (!Roofed(p)) {
        open.push_back(p);
        continue;
      }
      roofed.push_back(p);
      if (walk.Inside(p)) candidates.push_back(p);
    }
  }
  const size_t stride = std::max<size_t>(1, candidates.size() / kMaxAskedSamples);
  int asked = 0, between = 0;
  for (size_t i = 0; i < candidates.size(); i += stride) {
    ++asked;
    if (!BetweenWalls(candidates[i], solid)) continue;
    if (between++ == 0) parts.passage_at = candidates[i];
  }
  if (asked == 0 || between < kMinWalledShare * asked) return parts;
  const double reach = options_.ends_m + step;
  std::erase_if(open, [&](Point2 p) {
    return std::any_of(roofed.begin(), roofed.end(), [&](Point2 q) { return std::hypot(p.x - q.x, p.y - q.y) < reach; });
  });
  parts.passage_m2 = static_cast<double>(roofed.size()) * step * step;
  parts.elsewhere_m2 = static_cast<double>(open.size()) * step * step;
  if (!open.empty()) parts.elsewhere_at = open[0];
  return parts;
}

}  // namespace flaneur
