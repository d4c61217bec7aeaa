#include <algorithm>
#include <cmath>

#include "pipeline/footprint/check_parts.h"

namespace flaneur {
namespace {

// How deep a line goes into an obstacle, and where.
struct Depth {
  double depth_m = 0;
  Point2 at;
};

void GoThrough(Point2 a, Point2 b, const CheckedObstacle& entry, Depth* deepest) {
  std::vector<double> cuts{0, 1};
  const double dx = b.x - a.x, dy = b.y - a.y;
  for (const Ring& ring : entry.rings) {
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const double ex = ring[i].x - ring[j].x, ey = ring[i].y - ring[j].y, cross = dx * ey - dy * ex;
      if (cross == 0) continue;
      const double t = ((ring[j].x - a.x) * ey - (ring[j].y - a.y) * ex) / cross;
      const double u = ((ring[j].x - a.x) * dy - (ring[j].y - a.y) * dx) / cross;
      if (t > 0 && t < 1 && u >= 0 && u <= 1) cuts.push_back(t);
    }
  }
  std::sort(cuts.begin(), cuts.end());
  constexpr int kSamples = 8;  // in each piece
  for (size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double middle = (cuts[i] + cuts[i + 1]) / 2;
    if (cuts[i + 1] - cuts[i] < 1e-12 || !Contains(entry.rings, {a.x + middle * dx, a.y + middle * dy})) continue;
    for (int s = 0; s <= kSamples; ++s) {
      const double t = cuts[i] + (cuts[i + 1] - cuts[i]) * s / kSamples;
      const Point2 p{a.x + t * dx, a.y + t * dy};
      const double depth = DistanceToBoundary(entry.rings, p);
      if (depth > deepest->depth_m) *deepest = {depth, p};
    }
  }
}

bool InDoubt(const CheckedObstacle& entry, Point2 p) {
  return std::any_of(entry.doubt.begin(), entry.doubt.end(), [&](const Ring& hull) { return Contains(hull, p); });
}

}  // namespace

// Once for each street and obstacle.
void CheckStreets(CheckState* state) {
  const double tolerance = state->options.tolerance_m;
  const BoxGrid grid = GridOf(state->obstacles);
  for (const Centreline& street : state->options.streets) {
    Point2 min{1e300, 1e300}, max{-1e300, -1e300};
    for (const Point2& p : street.points_m) {
      min = {std::min(min.x, p.x), std::min(min.y, p.y)};
      max = {std::max(max.x, p.x), std::max(max.y, p.y)};
    }
    for (const size_t at : grid.Near({min, max})) {
      const CheckedObstacle& entry = state->obstacles[at];
      if (entry.duplicate || entry.points_missing) continue;
      Depth deepest;
      for (size_t i = 0; i + 1 < street.points_m.size(); ++i) {
        const Point2 a = street.points_m[i], b = street.points_m[i + 1];
        if (std::min(a.x, b.x) > entry.max.x || std::max(a.x, b.x) < entry.min.x || std::min(a.y, b.y) > entry.max.y ||
            std::max(a.y, b.y) < entry.min.y)
          continue;
        GoThrough(a, b, entry, &deepest);
      }
      if (deepest.depth_m > tolerance && !InDoubt(entry, deepest.at))
        state->Add(504, entry.obstacle->name, deepest.at, deepest.depth_m, tolerance,
                   "'" + street.name + "' runs through '" + entry.obstacle->name + "'", street.name);
    }
  }
}

}  // namespace flaneur
