#include "runtime/simulation/check_world.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/limits.h"
#include "runtime/crowd/constants.h"

namespace flaneur {
namespace {

struct Extent {
  Vec2 low, high;
};

// Of what of a box lies over the ground.
double AreaOver_m2(Vec2 low, Vec2 high, const Extent& ground) {
  const float width_m = std::min(high.x, ground.high.x) - std::max(low.x, ground.low.x);
  const float depth_m = std::min(high.y, ground.high.y) - std::max(low.y, ground.low.y);
  return width_m > 0 && depth_m > 0 ? static_cast<double>(width_m) * static_cast<double>(depth_m) : 0;
}

double RingArea_m2(const std::vector<Vec2>& ring, const Extent& ground) {
  Vec2 low = ring.front(), high = low;
  for (const Vec2 p : ring) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  return AreaOver_m2(low, high, ground);
}

// Cells of the navigation grid near a ring's walls.
double CellsNear(const std::vector<Vec2>& ring, double reach_m, double cell_m) {
  double length_m = 0;
  for (size_t i = 0; i < ring.size(); ++i)
    length_m += static_cast<double>(Length(ring[(i + 1) % ring.size()] - ring[i])) + 2 * reach_m + cell_m;
  return length_m * (2 * reach_m + cell_m) / (cell_m * cell_m);
}

}  // namespace

Error CheckWorld(const Walkable& w, float most_radius_m) {
  const GroundRaster& g = *w.ground;
  const Vec2 size = Vec2{static_cast<float>(g.columns), static_cast<float>(g.rows)} * g.cell_m;
  const Extent ground{g.min_m, g.min_m + size};
  const double ground_m2 = static_cast<double>(size.x) * static_cast<double>(size.y);
  const double cell_m =
      std::max(static_cast<double>(kNavigationCell_m), std::sqrt(ground_m2 / static_cast<double>(kMaxNavigationCells)));
  const double reach_m = static_cast<double>(most_radius_m) + 1;
  double covered_m2 = 0, near_cells = 0;
  const auto add_ring = [&](const std::vector<Vec2>& ring) {
    covered_m2 += RingArea_m2(ring, ground);
    near_cells += CellsNear(ring, reach_m, cell_m);
  };
  for (const PolygonObstacle& polygon : w.polygons) {
    add_ring(polygon.outer);
    for (const auto& hole : polygon.holes) add_ring(hole);
  }
  for (const CircleObstacle& c : w.circles) {
    const float r = c.radius_m + static_cast<float>(reach_m);
    covered_m2 += AreaOver_m2(c.center - Vec2{r, r}, c.center + Vec2{r, r}, ground);
  }
  if (covered_m2 > kMostLayers * ground_m2)
    return Fail("its obstacles lie over each other: together they would cover the ground more than " +
                std::to_string(static_cast<int>(kMostLayers)) + " times");
  if (near_cells > kMostCellsNearWalls) return Fail("its obstacles have more walls than the ground has room for");
  return Ok();
}

}  // namespace flaneur
