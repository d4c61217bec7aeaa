#include "pipeline/footprint/feet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/disjoint_sets.h"
#include "pipeline/footprint/enclosed_regions.h"
#include "pipeline/footprint/floors.h"
#include "pipeline/footprint/for_each.h"
#include "pipeline/footprint/overhead.h"
#include "pipeline/footprint/plan_raster.h"
#include "pipeline/footprint/segment_grid.h"
#include "pipeline/footprint/welded_shell.h"
#include "pipeline/io/triangulate_polygon.h"

namespace flaneur {
namespace {

constexpr double kLeastFace_m2 = 1e-6;  // in plan; what has less is an edge

Segment InPlan(const Point3& a, const Point3& b) { return {{a.x, a.y}, {b.x, b.y}}; }

// What the feet enclose under a roof, and a little more.
Rings StandingRoom(const std::vector<const TownObject*>& houses, const std::vector<Segment>& feet) {
  std::vector<const std::vector<Triangle3>*> triangles;
  for (const TownObject* house : houses) triangles.push_back(&house->triangles);
  const Overhead overhead(triangles);
  const auto is_roofed = [&](double, const std::vector<RegionSample>& samples) {
    return std::any_of(samples.begin(), samples.end(),
                       [&](const RegionSample& sample) { return overhead.Covers(sample.first, kLowest); });
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
  for (const auto& [edge, _] : shell.borders) {
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

// Neither upright nor without area.
bool IsFace(const Triangle3& t) {
  const auto& [a, b, c] = t;
  return !IsWall(t) && std::abs((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)) > kLeastFace_m2;
}

bool HasLowFace(const TownObject& house, double feet_m) {
  return std::any_of(house.triangles.begin(), house.triangles.end(), [&](const Triangle3& t) {
    return IsFace(t) && std::min({t[0].z, t[1].z, t[2].z}) <= feet_m + kFoot_m;
  });
}

// But for its walls.
bool LiesOver(const Rings& room, const TownObject& house) {
  return std::all_of(house.triangles.begin(), house.triangles.end(), [&](const Triangle3& t) {
    return !IsFace(t) || Contains(room, {(t[0].x + t[1].x + t[2].x) / 3, (t[0].y + t[1].y + t[2].y) / 3});
  });
}

// The loop of borders from a point, if it is one and on a level; else nothing.
std::vector<Point3> LevelLoop(const WeldedShell& shell, const Borders& borders, CornerIndex start,
                              std::set<CornerIndex>* done) {
  std::vector<Point3> ring;
  CornerIndex before = start, at = start;
  do {
    const std::set<CornerIndex>& next = borders.at(at);
    done->insert(at);
    if (next.size() != 2 || std::abs(shell.points[at].z - shell.points[start].z) > kFlatHole_m) return {};
    ring.push_back(shell.points[at]);
    const CornerIndex to = *next.begin() == before ? *next.rbegin() : *next.begin();
    before = at, at = to;
  } while (at != start);
  return ring;
}

// The floor that a house on several levels would have where its shell is open on a level.
std::vector<Triangle3> FloorOfHoles(const TownObject& house) {
  const WeldedShell shell = Weld(house.triangles);
  const Borders borders = ToBorders(shell.borders);
  std::vector<Triangle3> all = house.triangles;
  std::set<CornerIndex> done;
  for (const auto& [start, _] : borders) {
    if (done.contains(start)) continue;
    const std::vector<Point3> ring = LevelLoop(shell, borders, start, &done);
    if (ring.size() < 3) continue;
    for (const auto& [a, b, c] : TriangulatePolygon({ring})) all.push_back({ring[a], ring[b], ring[c]});
  }
  return all.size() > house.triangles.size() ? FloorOf(all, kMinFloor) : std::vector<Triangle3>();
}

using Houses = std::vector<TownObject*>;

// Those that have corners in common, together.
std::vector<Houses> Joined(const Houses& houses) {
  std::vector<Triangle3> all;
  std::vector<size_t> house_of;
  for (size_t k = 0; k < houses.size(); ++k) {
    all.insert(all.end(), houses[k]->triangles.begin(), houses[k]->triangles.end());
    house_of.resize(all.size(), k);
  }
  const WeldedShell shell = Weld(all);
  std::vector<size_t> first(shell.points.size(), houses.size());
  DisjointSets joined(houses.size());
  for (size_t i = 0; i < shell.triangles.size(); ++i) {
    const size_t house = house_of[shell.source[i]];
    for (const CornerIndex corner : shell.triangles[i])
      if (first[corner] == houses.size()) first[corner] = house;
      else joined.Join(first[corner], house);
  }
  std::map<size_t, Houses> by_first;
  for (size_t k = 0; k < houses.size(); ++k) by_first[joined.Root(k)].push_back(houses[k]);
  std::vector<Houses> groups;
  for (auto& [_, members] : by_first) groups.push_back(std::move(members));
  return groups;
}

// Whether any of the feet has a face of others at its height or below: it stands on their roofs.
bool StandOn(const LevelFeet& found, const std::vector<const std::vector<Triangle3>*>& others) {
  const Overhead faces(others);
  return std::any_of(found.feet.begin(), found.feet.end(), [&](const Segment& s) {
    const Point2 middle{(s.a.x + s.b.x) / 2, (s.a.y + s.b.y) / 2};
    return faces.LowestAbove(middle, kLowest) <= found.height_m + kFoot_m;
  });
}

void FindLevelFeet(const Houses& group, const Houses& block) {
  double lowest_m = std::numeric_limits<double>::max();
  for (const TownObject* house : group) lowest_m = std::min(lowest_m, house->min_m.z);
  const auto has_floor = [&](const TownObject* house) {
    return !house->foundation.empty() || HasLowFace(*house, lowest_m);
  };
  if (std::all_of(group.begin(), group.end(), has_floor)) return;
  const std::vector<const TownObject*> houses(group.begin(), group.end());
  const std::optional<LevelFeet> found = LevelFeetOf(houses);
  if (!found) {
    for (TownObject* house : group)
      if (!has_floor(house)) house->foundation = FloorOfHoles(*house);
    return;
  }
  std::vector<const std::vector<Triangle3>*> others;
  for (const TownObject* house : block)
    if (std::find(group.begin(), group.end(), house) == group.end()) others.push_back(&house->triangles);
  if (!others.empty() && StandOn(*found, others)) return;
  const Rings room = StandingRoom(houses, found->feet);
  for (TownObject* house : group) {
    if (!house->foundation.empty()) continue;
    house->level_feet_m = found->height_m;
    house->has_no_floor = !HasLowFace(*house, found->height_m) && LiesOver(room, *house);
  }
}

void FindLevelFeet(const Block& block, std::vector<TownObject>* objects) {
  Houses houses;
  for (const size_t i : block)
    if ((*objects)[i].kind == ObstacleKind::kBuilding) houses.push_back(&(*objects)[i]);
  const auto has_ground = [](const TownObject* house) { return !house->foundation.empty(); };
  if (std::all_of(houses.begin(), houses.end(), has_ground)) return;
  for (const Houses& group : Joined(houses)) FindLevelFeet(group, houses);
}

}  // namespace

void FindLevelFeet(const std::vector<Block>& blocks, int threads, std::vector<TownObject>* objects) {
  ForEach(blocks.size(), threads, [&](size_t k) { FindLevelFeet(blocks[k], objects); });
}

}  // namespace flaneur
