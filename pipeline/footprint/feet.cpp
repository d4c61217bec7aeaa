#include "pipeline/footprint/feet.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/enclosed_regions.h"
#include "pipeline/footprint/for_each.h"
#include "pipeline/footprint/overhead.h"
#include "pipeline/footprint/plan_raster.h"
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

struct LevelFeet {
  double height_m;
  std::vector<Segment> feet;
};

std::optional<LevelFeet> LevelFeetOf(const std::vector<const TownObject*>& houses) {
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
  if (others.empty()) return LevelFeet{lowest, std::move(feet)};
  const Rings room = StandingRoom(houses, feet);
  const bool all_over = std::all_of(others.begin(), others.end(), [&](const Segment& s) {
    return Contains(room, {(s.a.x + s.b.x) / 2, (s.a.y + s.b.y) / 2});
  });
  return all_over ? std::optional(LevelFeet{lowest, std::move(feet)}) : std::nullopt;
}

bool HasLowFace(const TownObject& house, double feet_m) {
  return std::any_of(house.triangles.begin(), house.triangles.end(), [&](const Triangle3& t) {
    return !IsWall(t) && std::min({t[0].z, t[1].z, t[2].z}) <= feet_m + kFoot_m;
  });
}

// But for its walls.
bool LiesOver(const Rings& room, const TownObject& house) {
  return std::all_of(house.triangles.begin(), house.triangles.end(), [&](const Triangle3& t) {
    return IsWall(t) || Contains(room, {(t[0].x + t[1].x + t[2].x) / 3, (t[0].y + t[1].y + t[2].y) / 3});
  });
}

void FindLevelFeet(const Block& block, std::vector<TownObject>* objects) {
  std::vector<const TownObject*> houses;
  double lowest_m = std::numeric_limits<double>::max();
  for (const size_t i : block) {
    const TownObject& object = (*objects)[i];
    if (object.kind != ObstacleKind::kBuilding) continue;
    houses.push_back(&object);
    lowest_m = std::min(lowest_m, object.min_m.z);
  }
  const auto has_floor = [&](const TownObject* house) {
    return !house->foundation.empty() || HasLowFace(*house, lowest_m);
  };
  if (std::all_of(houses.begin(), houses.end(), has_floor)) return;
  const std::optional<LevelFeet> found = LevelFeetOf(houses);
  if (!found) return;
  const Rings room = StandingRoom(houses, found->feet);
  for (const size_t i : block) {
    TownObject& object = (*objects)[i];
    if (object.kind != ObstacleKind::kBuilding || !object.foundation.empty()) continue;
    object.level_feet_m = found->height_m;
    object.has_no_floor = !HasLowFace(object, found->height_m) && LiesOver(room, object);
  }
}

}  // namespace

void FindLevelFeet(const std::vector<Block>& blocks, int threads, std::vector<TownObject>* objects) {
  ForEach(blocks.size(), threads, [&](size_t k) { FindLevelFeet(blocks[k], objects); });
}

}  // namespace flaneur
