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

bool Adjoin(const TownObject& a, const TownObject& b) {
  const auto apart = [](double a_max, double b_min) { return b_min > a_max + kBlockReach_m; };
  return !(apart(a.max_m.x, b.min_m.x) || apart(b.max_m.x, a.min_m.x) || apart(a.max_m.y, b.min_m.y) ||
           apart(b.max_m.y, a.min_m.y));
}

bool NearBox(const TownObject& object, const Ring& ring) {
  return std::any_of(ring.begin(), ring.end(), [&](const Point2& p) {
    return p.x >= object.min_m.x && p.x <= object.max_m.x && p.y >= object.min_m.y && p.y <= object.max_m.y;
  });
}

Rings Projection(const TownObject& object) {
  Rings rings;
  for (const Triangle3& t : object.triangles) {
    Ring ring{{t[0].x, t[0].y}, {t[1].x, t[1].y}, {t[2].x, t[2].y}};
    if (std::abs(SignedArea(ring)) > 1e-6) rings.push_back(std::move(ring));
  }
  return UnionOfRings(rings);
}

// Of a block, the objects that something is missing from, and those beside them.
Block WithOpenShells(const std::vector<TownObject>& objects, const Block& block, const std::vector<Shape>& shapes) {
  Block open;
  for (const size_t i : block) {
    const bool touched = std::any_of(block.begin(), block.end(), [&](size_t j) {
      return shapes[j].open_m > kMaxOpenShell_m && Adjoin(objects[i], objects[j]);
    });
    if (touched) open.push_back(i);
  }
  return open;
}

// One object of several, as far as the ground under them is concerned.
TownObject Merged(const std::vector<TownObject>& objects, const Block& block) {
  TownObject all = objects[block[0]];
  for (size_t k = 1; k < block.size(); ++k) {
    const TownObject& o = objects[block[k]];
    all.triangles.insert(all.triangles.end(), o.triangles.begin(), o.triangles.end());
    all.foundation.insert(all.foundation.end(), o.foundation.begin(), o.foundation.end());
    all.min_m = {std::min(all.min_m.x, o.min_m.x), std::min(all.min_m.y, o.min_m.y), std::min(all.min_m.z, o.min_m.z)};
    all.max_m = {std::max(all.max_m.x, o.max_m.x), std::max(all.max_m.y, o.max_m.y), std::max(all.max_m.z, o.max_m.z)};
  }
  return all;
}

// What the objects enclose under their roofs together, and none of them by itself.
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

// The object of the block that most of the piece lies under, by its place in the block; the block's size: none. The
// objects' projections are filled in as they are needed.
size_t OwnerOf(const Rings& piece, const std::vector<TownObject>& objects, const Block& block,
               std::vector<Rings>* projections) {
  size_t owner = block.size();
  double most_m2 = 0;
  for (size_t k = 0; k < block.size(); ++k) {
    if (!NearBox(objects[block[k]], piece[0])) continue;
    Rings& projection = (*projections)[k];
    if (projection.empty()) projection = Projection(objects[block[k]]);
    const double under_m2 = Area(Intersection(piece, projection));
    if (under_m2 > most_m2) most_m2 = under_m2, owner = k;
  }
  return owner;
}

}  // namespace

std::vector<Block> BlocksOf(const std::vector<TownObject>& objects) {
  std::vector<size_t> from_west;
  for (size_t i = 0; i < objects.size(); ++i)
    if (InBlocks(objects[i].kind)) from_west.push_back(i);
  std::sort(from_west.begin(), from_west.end(),
            [&](size_t i, size_t j) { return objects[i].min_m.x < objects[j].min_m.x; });
  DisjointSets adjoining(objects.size());
  for (size_t k = 0; k < from_west.size(); ++k) {
    const size_t i = from_west[k];
    for (size_t l = k + 1; l < from_west.size(); ++l) {
      const size_t j = from_west[l];
      if (objects[j].min_m.x > objects[i].max_m.x + kBlockReach_m) break;
      if (Adjoin(objects[i], objects[j])) adjoining.Join(i, j);
    }
  }
  std::map<size_t, Block> by_first;
  for (size_t i = 0; i < objects.size(); ++i) by_first[adjoining.Root(i)].push_back(i);
  std::vector<Block> blocks;
  for (auto& [_, members] : by_first) blocks.push_back(std::move(members));
  return blocks;
}

void ShareBlock(const Site& site, const std::vector<TownObject>& objects, const Block& whole_block,
                std::vector<Shape>* shapes) {
  const Block block = WithOpenShells(objects, whole_block, *shapes);
  if (block.empty()) return;
  const Rings gap = EnclosedTogether(site, objects, block, *shapes);
  std::vector<Rings> projections(block.size());
  for (const Polygon& piece : ToPolygons(gap)) {
    Rings rings{piece.outer};
    rings.insert(rings.end(), piece.holes.begin(), piece.holes.end());
    if (Area(rings) < kMinGap_m2) continue;
    const size_t owner = OwnerOf(rings, objects, block, &projections);
    if (owner == block.size()) continue;
    Shape& shape = (*shapes)[block[owner]];
    shape.solid = Union(shape.solid, rings);
    SetLoose(std::vector<Segment>(shape.loose), &shape);
  }
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
