#include "pipeline/footprint/repair_block.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/overhead.h"
#include "pipeline/footprint/plan_raster.h"
#include "pipeline/footprint/welded_shell.h"
#include "pipeline/io/triangulate_polygon.h"

namespace flaneur {
namespace {

using Loop = std::vector<CornerIndex>;

using Segment3 = std::array<Point3, 2>;

// How far the middle of a triangle lies to the left of an edge, in the plane that the normal tells; no unit.
double LeftOf(const Segment3& edge, const Point3& normal, const Triangle3& t) {
  const auto& [a, b] = edge;
  const auto& [x, y, z] = normal;
  const Point3 u{b.x - a.x, b.y - a.y, b.z - a.z};
  const auto from_a = [&](double p, double q, double r, double start) { return (p + q + r) / 3 - start; };
  return (y * u.z - z * u.y) * from_a(t[0].x, t[1].x, t[2].x, a.x) +
         (z * u.x - x * u.z) * from_a(t[0].y, t[1].y, t[2].y, a.y) +
         (x * u.y - y * u.x) * from_a(t[0].z, t[1].z, t[2].z, a.z);
}

bool AreAcross(const Triangle3& a, const Triangle3& b, const Segment3& edge) {
  const Point3 normal = NormalOf(b);
  return LeftOf(edge, normal, a) * LeftOf(edge, normal, b) < 0;
}

struct Origin {
  size_t member;
  bool of_foundation;
};

class BlockRepair {
 public:
  BlockRepair(const std::vector<const TownObject*>& houses, Holes holes)
      : houses_(houses), holes_(holes), overhead_(houses.size()) {
    for (size_t k = 0; k < houses.size(); ++k) {
      Add(houses[k]->triangles, {k, false});
      if (houses[k]->foundation_is_given) Add(houses[k]->foundation, {k, true});
    }
    shell_ = Weld(all_);
    borders_ = ToBorders(shell_.borders);
  }

  std::vector<MissingTriangle> Run() {
    for (size_t edges = 3; edges <= kMaxHoleEdges; ++edges) FillHolesOf(edges);
    return std::move(out_);
  }

 private:
  void Add(const std::vector<Triangle3>& triangles, Origin origin) {
    all_.insert(all_.end(), triangles.begin(), triangles.end());
    origin_.resize(all_.size(), origin);
  }

  void FillHolesOf(size_t edges) {
    std::vector<CornerEdge> starts;
    for (const auto& [a, others] : borders_)
      for (const CornerIndex b : others)
        if (a < b) starts.emplace_back(a, b);
    for (const auto& [a, b] : starts) {
      if (!IsBorder(a, b)) continue;
      const Loop loop = ShortestLoop(a, b, edges);
      if (loop.size() == edges) Fill(loop);
    }
  }

  bool IsBorder(CornerIndex a, CornerIndex b) const {
    const auto entry = borders_.find(a);
    return entry != borders_.end() && entry->second.contains(b);
  }

  // The way round from b to a along other borders, a first; empty where it has more than so many edges.
  Loop ShortestLoop(CornerIndex a, CornerIndex b, size_t most_edges) const {
    std::map<CornerIndex, CornerIndex> from{{b, b}};
    std::vector<CornerIndex> front{b};
    for (size_t length = 1; length < most_edges && !front.empty(); ++length) {
      std::vector<CornerIndex> next;
      for (const CornerIndex p : front) {
        for (const CornerIndex q : borders_.at(p)) {
          if ((p == b && q == a) || !from.try_emplace(q, p).second) continue;
          if (q == a) return Backwards(from, a, b);
          next.push_back(q);
        }
      }
      front = std::move(next);
    }
    return {};
  }

  static Loop Backwards(const std::map<CornerIndex, CornerIndex>& from, CornerIndex a, CornerIndex b) {
    Loop loop{a};
    while (loop.back() != b) loop.push_back(from.at(loop.back()));
    return loop;
  }

  Triangle3 At3(const Corners& c) const { return {shell_.points[c[0]], shell_.points[c[1]], shell_.points[c[2]]}; }

  void Fill(const Loop& loop) {
    const std::vector<Corners> filling = FillingOf(loop);
    if (filling.empty() || std::any_of(filling.begin(), filling.end(), [&](Corners t) { return IsThere(t); })) return;
    const auto goes_on = [&](const Corners& t) { return GoesOn(t, loop); };
    if (holes_ == Holes::kPartsOfFaces && !std::all_of(filling.begin(), filling.end(), goes_on)) return;
    std::vector<MissingTriangle> found;
    for (const Corners& t : filling) {
      const std::optional<MissingTriangle> one = WithOwner(t, loop);
      if (!one) return;
      if (ThicknessOf(one->triangle) > kThinTriangle_m) found.push_back(*one);
    }
    for (size_t i = 0; i < loop.size(); ++i) RemoveBorder(loop[i], loop[(i + 1) % loop.size()], &borders_);
    out_.insert(out_.end(), found.begin(), found.end());
  }

  bool IsThere(Corners t) const {
    std::sort(t.begin(), t.end());
    return std::binary_search(shell_.triangles.begin(), shell_.triangles.end(), t);
  }

  std::vector<Point3> RingOf(const Loop& loop) const {
    std::vector<Point3> ring;
    for (const CornerIndex i : loop) ring.push_back(shell_.points[i]);
    return ring;
  }

  std::vector<Corners> Triangulated(const Loop& loop) const {
    std::vector<Corners> out;
    for (const auto& [a, b, c] : TriangulatePolygon({RingOf(loop)})) out.push_back({loop[a], loop[b], loop[c]});
    return out;
  }

  // Corners that go on in the planes beside them are cut off until the rest is plane; nothing where it never is.
  std::vector<Corners> FillingOf(const Loop& loop) const {
    std::vector<Corners> filling;
    Loop rest = loop;
    while (rest.size() > 3 && !IsPlane(RingOf(rest))) {
      const std::optional<size_t> ear = FindEar(rest, loop);
      if (!ear) return {};
      filling.push_back(EarAt(rest, *ear));
      rest.erase(rest.begin() + static_cast<long>(*ear));
    }
    const std::vector<Corners> plane = rest.size() == 3 ? std::vector{EarAt(rest, 1)} : Triangulated(rest);
    const auto goes_on = [&](const Corners& t) { return GoesOn(t, loop); };
    if (!filling.empty() && std::none_of(plane.begin(), plane.end(), goes_on)) return {};
    filling.insert(filling.end(), plane.begin(), plane.end());
    return filling;
  }
  static Corners EarAt(const Loop& loop, size_t i) {
    return {loop[(i + loop.size() - 1) % loop.size()], loop[i], loop[(i + 1) % loop.size()]};
  }
  std::optional<size_t> FindEar(const Loop& rest, const Loop& loop) const {
    for (size_t i = 0; i < rest.size(); ++i)
      if (GoesOn(EarAt(rest, i), loop) && !IsThere(EarAt(rest, i))) return i;
    return std::nullopt;
  }

  // Whether it lies in the plane of one beside it, across their edge.
  bool GoesOn(const Corners& t, const Loop& loop) const {
    bool any = false;
    ForNeighbours(t, loop, [&](size_t beside, const Segment3& edge) {
      any |= GoesOnIn(At3(t), all_[beside]) && AreAcross(At3(t), all_[beside], edge);
    });
    return any;
  }

  // visit(triangle, edge) for those beside the hole's edges that are the triangle's.
  template <typename Visit>
  void ForNeighbours(const Corners& t, const Loop& loop, const Visit& visit) const {
    for (size_t i = 0; i < loop.size(); ++i) {
      const CornerIndex a = loop[i], b = loop[(i + 1) % loop.size()];
      if (std::find(t.begin(), t.end(), a) == t.end() || std::find(t.begin(), t.end(), b) == t.end()) continue;
      visit(shell_.source[TriangleAt(shell_.borders, a, b)], Segment3{shell_.points[a], shell_.points[b]});
    }
  }

  // By what lies over or under it, then by the plane, then by the longest edge. None: level, of no
  // face that is there, and nothing is over or under it.
  std::optional<MissingTriangle> WithOwner(const Corners& corners, const Loop& loop) {
    const Triangle3 t = At3(corners);
    const Point2 middle{(t[0].x + t[1].x + t[2].x) / 3, (t[0].y + t[1].y + t[2].y) / 3};
    using Rank = std::tuple<bool, bool, double>;
    std::optional<Rank> best;
    MissingTriangle out{t};
    ForNeighbours(corners, loop, [&](size_t beside, const Segment3& edge) {
      const Origin& origin = origin_[beside];
      const Rank rank{CoverOf(origin.member).Covers(middle, kLowest), GoesOnIn(t, all_[beside]),
                      Distance(edge[0], edge[1])};
      if (best && rank <= *best) return;
      best = rank;
      out.member = origin.member, out.of_foundation = origin.of_foundation;
      out.is_of_face |= loop.size() == 3 && std::get<1>(rank);
    });
    const bool may_be_open = loop.size() > 3 && !IsWall(t) && !GoesOn(corners, loop);
    if (!best || (may_be_open && !std::get<0>(*best))) return std::nullopt;
    return out;
  }

  const Overhead& CoverOf(size_t member) {
    if (!overhead_[member]) overhead_[member].emplace(std::vector{&houses_[member]->triangles});
    return *overhead_[member];
  }

  const std::vector<const TownObject*>& houses_;
  const Holes holes_;
  std::vector<Triangle3> all_;
  std::vector<Origin> origin_;  // of each
  WeldedShell shell_;
  Borders borders_;
  std::vector<std::optional<Overhead>> overhead_;
  std::vector<MissingTriangle> out_;
};

}  // namespace

std::vector<MissingTriangle> MissingTogether(const std::vector<const TownObject*>& houses, Holes holes) {
  return BlockRepair(houses, holes).Run();
}

}  // namespace flaneur
