// Which house of a block stands where.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "pipeline/footprint/blocks.h"
#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/object_shape.h"

namespace flaneur {
namespace {

bool Apart(const BoundingBox& a, const BoundingBox& b) {
  return a.max.x < b.min.x || b.max.x < a.min.x || a.max.y < b.min.y || b.max.y < a.min.y;
}

void Append(const Rings& more, Rings* to) { to->insert(to->end(), more.begin(), more.end()); }

Rings WithHoles(const Polygon& polygon) {
  Rings rings{polygon.outer};
  Append(polygon.holes, &rings);
  return rings;
}

// The houses of one block while what they enclose is shared out.
class BlockShares {
 public:
  BlockShares(const Site& site, const std::vector<TownObject>& objects, const Block& block, std::vector<Shape>* shapes)
      : site_(site),
        objects_(objects),
        block_(block),
        shapes_(*shapes),
        asks_(block.size(), false),
        grounds_(block.size()),
        roofs_(block.size()) {}

  void Run() {
    FindThoseThatAsk();
    if (std::none_of(asks_.begin(), asks_.end(), [](bool asks) { return asks; })) return;
    const Block near = AskingAndNeighbours();
    const Rings enclosed = AnyOpen(near) ? EnclosedTogether(site_, objects_, near, shapes_) : Rings();
    ShareOut(enclosed);
    StandOnGroundSurfaces();
    ForgetCoveredWalls(near);
  }

 private:
  const TownObject& Object(size_t k) const { return objects_[block_[k]]; }
  Shape& ShapeAt(size_t k) { return shapes_[block_[k]]; }
  bool HasGround(size_t k) const { return !Object(k).foundation.empty(); }

  const Rings& Ground(size_t k) {
    if (grounds_[k].empty() && HasGround(k)) grounds_[k] = InPlan(Object(k).foundation);
    return grounds_[k];
  }
  const Rings& Roof(size_t k) {
    if (roofs_[k].empty()) roofs_[k] = InPlan(Object(k).triangles);
    return roofs_[k];
  }
  bool IsHouse(size_t k) const { return Object(k).kind == ObstacleKind::kBuilding; }

  // Open houses, such as lack all walls, and such as enclose another's ground, with that other.
  void FindThoseThatAsk() {
    for (size_t k = 0; k < block_.size(); ++k) {
      if (!IsHouse(k)) continue;
      Shape& shape = ShapeAt(k);
      const bool has_nothing = shape.solid.empty() && (HasGround(k) || (shape.lines == 0 && !site_.ground));
      if (shape.open_m > kMaxOpenShell_m || has_nothing) asks_[k] = true;
      if (block_.size() == 1 || !MayIntrude(k)) continue;
      const BoundingBox box = BoundingBoxOf(shape.solid);
      for (size_t l = 0; l < block_.size(); ++l)
        if (l != k && IsHouse(l) && HasGround(l) && Adjoin(Object(k), Object(l)) && Intrudes(k, box, l))
          asks_[k] = asks_[l] = true;
    }
  }

  // Whether it encloses clearly more than its own ground.
  bool MayIntrude(size_t k) {
    const Shape& shape = ShapeAt(k);
    return !shape.solid.empty() && (!HasGround(k) || Area(shape.solid) > Area(Ground(k)) + kMinClaim_m2);
  }
  bool Intrudes(size_t k, const BoundingBox& box, size_t l) {
    const Rings& other = Ground(l);
    if (Apart(box, BoundingBoxOf(other))) return false;
    const Rings shared = Intersection(ShapeAt(k).solid, other);
    return Area(HasGround(k) ? Difference(shared, Ground(k)) : shared) > kMinClaim_m2;
  }

  Block AskingAndNeighbours() const {
    Block near;
    for (size_t k = 0; k < block_.size(); ++k) {
      bool is_near = asks_[k];
      for (size_t l = 0; l < block_.size() && !is_near; ++l) is_near = asks_[l] && Adjoin(Object(k), Object(l));
      if (is_near) near.push_back(block_[k]);
    }
    return near;
  }
  bool AnyOpen(const Block& near) const {
    return near.size() > 1 &&
           std::any_of(near.begin(), near.end(), [&](size_t i) { return shapes_[i].open_m > kMaxOpenShell_m; });
  }

  // First by the ground, then by the roofs, then by what it lies against.
  void ShareOut(const Rings& enclosed) {
    Rings all = enclosed, settled;
    for (size_t k = 0; k < block_.size(); ++k) Append(ShapeAt(k).solid, asks_[k] ? &all : &settled);
    all = DifferenceOfAreas(UnionOfAreas(all), settled);
    if (all.empty()) return;
    std::vector<Rings> shares(block_.size());
    Rings taken;
    for (size_t k = 0; k < block_.size(); ++k)
      if (asks_[k] && HasGround(k)) Append(shares[k] = Intersection(all, Ground(k)), &taken);
    all = DifferenceOfAreas(all, taken);
    for (size_t k = 0; k < block_.size(); ++k) {
      if (!asks_[k] || HasGround(k) || all.empty()) continue;
      shares[k] = Intersection(all, Roof(k));
      all = DifferenceOfAreas(all, shares[k]);
    }
    for (size_t k = 0; k < block_.size(); ++k)
      if (!asks_[k]) shares[k] = ShapeAt(k).solid;
    std::vector<Rings> more(block_.size());
    for (const Polygon& piece : ToPolygons(all)) {
      const Rings rings = WithHoles(piece);
      if (Area(rings) < kMinStrip_m2) continue;
      const size_t owner = OwnerOf(rings, shares);
      if (owner < block_.size()) Append(Offset(rings, kAgainst_m), &more[owner]);
    }
    for (size_t k = 0; k < block_.size(); ++k) {
      if (!asks_[k] && more[k].empty()) continue;
      Append(more[k], &shares[k]);
      ShapeAt(k).solid = UnionOfAreas(shares[k]);
    }
  }

  // By the roof over most of a piece, or where it is a mere strip by the longest joint, else whose it was, as a post's
  // without a top; the block's size: nobody.
  size_t OwnerOf(const Rings& piece, const std::vector<Rings>& shares) {
    const bool strip = Offset(piece, -kStripe_m / 2).empty();
    const Rings grown = Offset(piece, kStripe_m / 2);
    const BoundingBox box = BoundingBoxOf(grown);
    size_t owner = block_.size();
    double most_m2 = 0;
    const auto look = [&](const auto& shared) {
      for (size_t k = 0; k < block_.size(); ++k) {
        const TownObject& o = Object(k);
        if (Apart(box, {{o.min_m.x, o.min_m.y}, {o.max_m.x, o.max_m.y}})) continue;
        const double shared_m2 = Area(shared(k));
        if (shared_m2 > most_m2) most_m2 = shared_m2, owner = k;
      }
    };
    std::array<std::function<Rings(size_t)>, 3> shared{
        [&](size_t k) { return Intersection(piece, Roof(k)); },
        [&](size_t k) { return Intersection(grown, shares[k]); },
        [&](size_t k) { return Intersection(piece, ShapeAt(k).solid); },
    };
    if (strip) std::swap(shared[0], shared[1]);
    for (const auto& each : shared)
      if (owner == block_.size()) look(each);
    return owner;
  }

  // Houses whose model has no walls at all.
  void StandOnGroundSurfaces() {
    for (size_t k = 0; k < block_.size(); ++k) {
      Shape& shape = ShapeAt(k);
      if (!asks_[k] || !shape.solid.empty() || shape.lines > 0 || !HasGround(k)) continue;
      const TownObject& object = Object(k);
      const Point3& at = object.foundation[0][0];
      if (site_.ground && std::abs(site_.ground->Height(at.x, at.y) - at.z) > kSameGround_m) continue;
      if (object.max_m.z < at.z + site_.options.band_m[1]) continue;
      Rings others;
      for (size_t l = 0; l < block_.size(); ++l)
        if (l != k && Adjoin(object, Object(l))) Append(ShapeAt(l).solid, &others);
      shape.solid = DifferenceOfAreas(Ground(k), others);
      shape.guessed = true;
    }
  }

  // Walls that others' parts lie against are no loose ones.
  void ForgetCoveredWalls(const Block& near) {
    Rings all;
    for (const size_t i : near) Append(shapes_[i].solid, &all);
    all = UnionOfAreas(all);
    for (const size_t i : near) {
      if (shapes_[i].loose.empty()) continue;
      SetLoose(std::vector<Segment>(shapes_[i].loose), all, &shapes_[i]);
    }
  }

  const Site& site_;
  const std::vector<TownObject>& objects_;
  const Block& block_;
  std::vector<Shape>& shapes_;
  std::vector<bool> asks_;
  std::vector<Rings> grounds_, roofs_;  // in plan, as they are needed
};

}  // namespace

void ShareBlock(const Site& site, const std::vector<TownObject>& objects, const Block& block,
                std::vector<Shape>* shapes) {
  BlockShares(site, objects, block, shapes).Run();
}

}  // namespace flaneur
