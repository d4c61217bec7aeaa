#include "pipeline/footprint/feet.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/enclosed_regions.h"
#include "pipeline/footprint/for_each.h"
#include "pipeline/footprint/overhead.h"
#include "pipeline/footprint/segment_grid.h"
#include "pipeline/footprint/welded_shell.h"

namespace flaneur {
namespace {

Segment InPlan(const Point3& a, const Point3& b) { return {{a.x, a.y}, {b.x, b.y}}; }

// What the feet enclose under a roof, and a little more.
Rings StandingRoom(const std::vector<const TownObject*>& houses, const std::vector<Segment>& feet) {
  std::vector<const std::vector<Triangle3>*> triangles;
  for (const TownObject* house : houses) triangles.push_back(&house->triangles);
  const Overhead overhead(triangles);
  const auto is_roofed = [&](double, const std::vector<RegionSample>& samples) {
    return std::any_of(samples.begin(), samples.end(), [&](const RegionSample& sample) {
      return overhead.Covers(sample.first, -std::numeric_limits<double>::infinity());
    });
  };
  return Offset(EncloseRegions(CutWhereTheyMeet(feet), is_roofed).solid, kFoot_m);
}

std::optional<double> LevelFeetOf(const std::vector<const TownObject*>& houses) {
  std::vector<Triangle3> all;
  for (const TownObject* house : houses) all.insert(all.end(), house->triangles.begin(), house->triangles.end());
  const WeldedShell shell = Weld(all);
  double lowest = std::numeric_limits<double>::max();
  for (const Point3& p : shell.points) lowest = std::min(lowest, p.z);
  std::vector<Segment> feet, others;
  for (const auto& [edge, _] : FindBorderEdges(shell)) {
    const Point3 &a = shell.points[edge.first], &b = shell.points[edge.second];
    (std::max(a.z, b.z) <= lowest + kLevelGround_m ? feet : others).push_back(InPlan(a, b));
  }
  if (feet.empty()) return std::nullopt;
  if (others.empty()) return lowest;
  const Rings room = StandingRoom(houses, feet);
  const bool all_over = std::all_of(others.begin(), others.end(), [&](const Segment& s) {
    return Contains(room, {(s.a.x + s.b.x) / 2, (s.a.y + s.b.y) / 2});
  });
  return all_over ? std::optional(lowest) : std::nullopt;
}

}  // namespace

void FindLevelFeet(const std::vector<Block>& blocks, int threads, std::vector<TownObject>* objects) {
  ForEach(blocks.size(), threads, [&](size_t k) {
    std::vector<const TownObject*> houses;
    for (const size_t i : blocks[k])
      if ((*objects)[i].kind == ObstacleKind::kBuilding) houses.push_back(&(*objects)[i]);
    const auto has_no_floor = [](const TownObject* house) { return house->has_no_floor; };
    if (std::none_of(houses.begin(), houses.end(), has_no_floor)) return;
    const std::optional<double> feet_m = LevelFeetOf(houses);
    for (const size_t i : blocks[k])
      if ((*objects)[i].has_no_floor) (*objects)[i].level_feet_m = feet_m;
  });
}

}  // namespace flaneur
