#include "pipeline/footprint/repair_shell.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/welded_shell.h"
#include "pipeline/io/triangulate_polygon.h"

namespace flaneur {
namespace {

class Repair {
 public:
  explicit Repair(WeldedShell shell) : shell_(std::move(shell)), borders_(ToBorders(shell_.borders)) {}

  MissingFromShell Run() {
    FillTriangles();
    std::vector<std::vector<CornerIndex>> holes;
    if (Closable(&holes) && !(holes.size() == 1 && out_.triangles.empty() && IsWall(holes[0])))
      for (const std::vector<CornerIndex>& hole : holes) Fill(hole);
    return std::move(out_);
  }

 private:
  void FillTriangles() {
    std::vector<CornerIndex> starts;
    for (const auto& [a, _] : borders_) starts.push_back(a);
    for (const CornerIndex a : starts)
      while (FillOneAt(a)) {}
  }

  bool FillOneAt(CornerIndex a) {
    const auto entry = borders_.find(a);
    if (entry == borders_.end()) return false;
    for (const CornerIndex b : entry->second) {
      for (const CornerIndex c : entry->second) {
        if (!(b < c) || !borders_[b].contains(c)) continue;
        Corners corners{a, b, c};
        std::sort(corners.begin(), corners.end());
        if (std::binary_search(shell_.triangles.begin(), shell_.triangles.end(), corners)) continue;
        RemoveBorder(a, b, &borders_), RemoveBorder(b, c, &borders_), RemoveBorder(a, c, &borders_);
        if (Add(corners)) out_.of_faces += IsOfFace(corners);
        return true;
      }
    }
    return false;
  }

  // Whether all that is left are short loops, each once round.
  bool Closable(std::vector<std::vector<CornerIndex>>* holes) const {
    std::set<CornerIndex> done;
    for (const auto& [start, neighbours] : borders_) {
      if (neighbours.size() != 2) return false;
      if (!done.insert(start).second) continue;
      std::vector<CornerIndex> hole{start};
      for (CornerIndex before = start, at = *neighbours.begin(); at != start;) {
        if (hole.size() == kMaxHoleEdges) return false;
        hole.push_back(at);
        done.insert(at);
        const std::set<CornerIndex>& next = borders_.at(at);
        if (next.size() != 2) return false;
        const CornerIndex to = *next.begin() == before ? *next.rbegin() : *next.begin();
        before = at, at = to;
      }
      holes->push_back(std::move(hole));
    }
    return true;
  }

  // An upright rectangle on the bottom, alone or together with a floor.
  bool IsWall(const std::vector<CornerIndex>& hole) const {
    const size_t n = hole.size();
    const auto point = [&](size_t i) { return shell_.points[hole[i % n]]; };
    double lowest = point(0).z;
    for (size_t i = 1; i < n; ++i) lowest = std::min(lowest, point(i).z);
    const auto is_high = [&](size_t i) { return point(i).z > lowest + kFoot_m; };
    const auto is_over = [&](size_t i, size_t below) {
      return std::hypot(point(i).x - point(below).x, point(i).y - point(below).y) < kThinTriangle_m;
    };
    size_t high = 0;
    for (size_t i = 0; i < n; ++i) high += is_high(i);
    for (size_t i = 0; i < n && high == 2; ++i)
      if (is_high(i) && is_high(i + 1)) return n >= 4 && is_over(i, i + n - 1) && is_over(i + 1, i + 2);
    return false;
  }

  void Fill(const std::vector<CornerIndex>& hole) {
    std::vector<Point3> ring;
    for (const CornerIndex i : hole) ring.push_back(shell_.points[i]);
    if (!IsPlane(ring)) return;  // two walls that met at a corner, say
    for (const auto& [a, b, c] : TriangulatePolygon({ring})) Add({hole[a], hole[b], hole[c]});
  }

  Triangle3 ToTriangle(const Corners& c) const {
    return {shell_.points[c[0]], shell_.points[c[1]], shell_.points[c[2]]};
  }

  bool Add(const Corners& corners) {
    const Triangle3 t = ToTriangle(corners);
    if (ThicknessOf(t) <= kThinTriangle_m) return false;
    out_.triangles.push_back(t);
    return true;
  }

  bool IsOfFace(const Corners& c) const {
    const auto goes_on = [&](CornerIndex a, CornerIndex b) {
      return GoesOnIn(ToTriangle(c), ToTriangle(shell_.triangles[TriangleAt(shell_.borders, a, b)]));
    };
    return goes_on(c[0], c[1]) || goes_on(c[1], c[2]) || goes_on(c[0], c[2]);
  }

  WeldedShell shell_;
  Borders borders_;
  MissingFromShell out_;
};

}  // namespace

MissingFromShell MissingTriangles(const std::vector<Triangle3>& shell) { return Repair(Weld(shell)).Run(); }

}  // namespace flaneur
