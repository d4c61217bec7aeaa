#include "pipeline/footprint/blocks.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/disjoint_sets.h"
#include "pipeline/footprint/object_shape.h"

namespace flaneur {
namespace {

bool InBlocks(ObstacleKind kind) { return kind == ObstacleKind::kBuilding || kind == ObstacleKind::kWall; }

// One object of several, as far as the ground under them is concerned.
TownObject Merged(const std::vector<TownObject>& objects, const Block& block) {
  TownObject all = objects[block[0]];
  for (size_t k = 1; k < block.size(); ++k) {
    const TownObject& o = objects[block[k]];
    all.triangles.insert(all.triangles.end(), o.triangles.begin(), o.triangles.end());
    all.has_no_floor |= o.has_no_floor;
    if (o.level_feet_m) all.level_feet_m = o.level_feet_m;
    all.foundation_is_given |= o.foundation_is_given;
    all.foundation.insert(all.foundation.end(), o.foundation.begin(), o.foundation.end());
    all.min_m = {std::min(all.min_m.x, o.min_m.x), std::min(all.min_m.y, o.min_m.y), std::min(all.min_m.z, o.min_m.z)};
    all.max_m = {std::max(all.max_m.x, o.max_m.x), std::max(all.max_m.y, o.max_m.y), std::max(all.max_m.z, o.max_m.z)};
  }
  // Where some have none, the others' floors that were found may be roofs.
  if (all.has_no_floor && !all.foundation_is_given) all.foundation.clear();
  return all;
}

}  // namespace

bool Adjoin(const TownObject& a, const TownObject& b) {
  const auto apart = [](double a_max, double b_min) { return b_min > a_max + kBlockReach_m; };
  return !(apart(a.max_m.x, b.min_m.x) || apart(b.max_m.x, a.min_m.x) || apart(a.max_m.y, b.min_m.y) ||
           apart(b.max_m.y, a.min_m.y));
}

std::vector<std::vector<size_t>> Adjoining(const std::vector<TownObject>& objects) {
  std::vector<size_t> from_west;
  for (size_t i = 0; i < objects.size(); ++i)
    if (InBlocks(objects[i].kind)) from_west.push_back(i);
  std::sort(from_west.begin(), from_west.end(),
            [&](size_t i, size_t j) { return objects[i].min_m.x < objects[j].min_m.x; });
  std::vector<std::vector<size_t>> adjoining(objects.size());
  for (size_t k = 0; k < from_west.size(); ++k) {
    const size_t i = from_west[k];
    for (size_t l = k + 1; l < from_west.size(); ++l) {
      const size_t j = from_west[l];
      if (objects[j].min_m.x > objects[i].max_m.x + kBlockReach_m) break;
      if (Adjoin(objects[i], objects[j])) adjoining[i].push_back(j), adjoining[j].push_back(i);
    }
  }
  for (std::vector<size_t>& each : adjoining) std::sort(each.begin(), each.end());
  return adjoining;
}

std::vector<Block> BlocksOf(const std::vector<std::vector<size_t>>& adjoining) {
  DisjointSets joined(adjoining.size());
  for (size_t i = 0; i < adjoining.size(); ++i)
    for (const size_t j : adjoining[i]) joined.Join(i, j);
  std::map<size_t, Block> by_first;
  for (size_t i = 0; i < adjoining.size(); ++i) by_first[joined.Root(i)].push_back(i);
  std::vector<Block> blocks;
  for (auto& [_, members] : by_first) blocks.push_back(std::move(members));
  return blocks;
}

Rings EnclosedTogether(const Site& site, const std::vector<TownObject>& objects, const Block& block,
                       const std::vector<Shape>& shapes) {
  std::vector<Segment> lines;
  Rings known;
  std::vector<const std::vector<Triangle3>*> triangles;
  for (const size_t i : block) {
    const Shape& own = shapes[i];
    lines.insert(lines.end(), own.loose.begin(), own.loose.end());
    known.insert(known.end(), own.solid.begin(), own.solid.end());
    triangles.push_back(&objects[i].triangles);
  }
  known = UnionOfAreas(known);
  Shape whole;
  whole.solid = known;
  const Stand stand(site, Merged(objects, block));
  const Overhead overhead(triangles);
  CloseUnderRoofs(lines, site.options.bridge_m, Roofs(site, stand.ground(0), overhead), &whole);
  return Difference(whole.solid, known);
}

void MergeBlock(const Block& block, std::vector<Shape>* shapes) {
  Shape& first = (*shapes)[block[0]];
  for (size_t k = 1; k < block.size(); ++k) {
    Shape& other = (*shapes)[block[k]];
    first.solid = Union(first.solid, other.solid);
    first.loose.insert(first.loose.end(), other.loose.begin(), other.loose.end());
    first.open_shell |= other.open_shell;
    other.solid.clear(), other.loose.clear();
  }
}

}  // namespace flaneur
