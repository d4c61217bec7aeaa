#include "pipeline/footprint/repair_shell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "pipeline/footprint/constants.h"
#include "pipeline/io/triangulate_polygon.h"

namespace flaneur {
namespace {

using Index = uint32_t;
using Edge = std::pair<Index, Index>;  // the lesser first

struct Welded {
  std::vector<Point3> points;
  std::vector<std::array<Index, 3>> triangles;  // corners ascending; sorted, each once
};

bool Before(const Point3& a, const Point3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

Welded Weld(const std::vector<Triangle3>& shell) {
  using Cell = std::array<int64_t, 3>;
  std::vector<std::pair<Cell, Index>> corners;  // of all triangles, one after the other
  corners.reserve(3 * shell.size());
  for (const Triangle3& t : shell) {
    for (const Point3& p : t) {
      const auto cell = [](double v) { return static_cast<int64_t>(std::llround(v / kSameCorner_m)); };
      corners.emplace_back(Cell{cell(p.x), cell(p.y), cell(p.z)}, static_cast<Index>(corners.size()));
    }
  }
  std::sort(corners.begin(), corners.end());
  Welded out;
  std::vector<Index> point_of(corners.size());
  for (size_t i = 0; i < corners.size(); ++i) {
    const Index corner = corners[i].second;
    const Point3& at = shell[corner / 3][corner % 3];
    if (i == 0 || corners[i].first != corners[i - 1].first) out.points.push_back(at);
    else if (Before(at, out.points.back())) out.points.back() = at;
    point_of[corner] = static_cast<Index>(out.points.size() - 1);
  }
  for (size_t i = 0; i < shell.size(); ++i) {
    std::array<Index, 3> t{point_of[3 * i], point_of[3 * i + 1], point_of[3 * i + 2]};
    std::sort(t.begin(), t.end());
    if (t[0] != t[1] && t[1] != t[2]) out.triangles.push_back(t);
  }
  std::sort(out.triangles.begin(), out.triangles.end());
  out.triangles.erase(std::unique(out.triangles.begin(), out.triangles.end()), out.triangles.end());
  return out;
}

// Neighbours of each point along edges that belong to one triangle only.
using Borders = std::map<Index, std::set<Index>>;

Borders FindBorders(const Welded& shell) {
  std::vector<Edge> edges;
  edges.reserve(3 * shell.triangles.size());
  for (const auto& [a, b, c] : shell.triangles) edges.insert(edges.end(), {{a, b}, {b, c}, {a, c}});
  std::sort(edges.begin(), edges.end());
  Borders borders;
  for (size_t i = 0, next; i < edges.size(); i = next) {
    for (next = i + 1; next < edges.size() && edges[next] == edges[i];) ++next;
    if (next == i + 1) borders[edges[i].first].insert(edges[i].second), borders[edges[i].second].insert(edges[i].first);
  }
  return borders;
}

void Remove(Index a, Index b, Borders* borders) {
  for (const auto& [from, to] : {Edge{a, b}, Edge{b, a}}) {
    const auto entry = borders->find(from);
    entry->second.erase(to);
    if (entry->second.empty()) borders->erase(entry);
  }
}

double Length(const Point3& a, const Point3& b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

Point3 Normal(const Triangle3& t) {  // as long as twice the area
  const auto& [a, b, c] = t;
  return {(b.y - a.y) * (c.z - a.z) - (b.z - a.z) * (c.y - a.y), (b.z - a.z) * (c.x - a.x) - (b.x - a.x) * (c.z - a.z),
          (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)};
}

double Thickness(const Triangle3& t) {
  const Point3 n = Normal(t);
  const double longest = std::max({Length(t[0], t[1]), Length(t[1], t[2]), Length(t[2], t[0])});
  return longest > 0 ? std::hypot(n.x, n.y, n.z) / longest : 0;
}

class Repair {
 public:
  explicit Repair(Welded shell) : shell_(std::move(shell)), borders_(FindBorders(shell_)) {}

  std::vector<Triangle3> Run() {
    FillTriangles();
    std::vector<std::vector<Index>> holes;
    if (Closable(&holes) && !(holes.size() == 1 && out_.empty() && IsWall(holes[0])))
      for (const std::vector<Index>& hole : holes) Fill(hole);
    return std::move(out_);
  }

 private:
  void FillTriangles() {
    std::vector<Index> starts;
    for (const auto& [a, _] : borders_) starts.push_back(a);
    for (const Index a : starts)
      while (FillOneAt(a)) {}
  }

  bool FillOneAt(Index a) {
    const auto entry = borders_.find(a);
    if (entry == borders_.end()) return false;
    for (const Index b : entry->second) {
      for (const Index c : entry->second) {
        if (!(b < c) || !borders_[b].contains(c)) continue;
        std::array<Index, 3> corners{a, b, c};
        std::sort(corners.begin(), corners.end());
        if (std::binary_search(shell_.triangles.begin(), shell_.triangles.end(), corners)) continue;
        Remove(a, b, &borders_), Remove(b, c, &borders_), Remove(a, c, &borders_);
        Add(corners);
        return true;
      }
    }
    return false;
  }

  // Whether all that is left are short loops, each once round.
  bool Closable(std::vector<std::vector<Index>>* holes) const {
    std::set<Index> done;
    for (const auto& [start, neighbours] : borders_) {
      if (neighbours.size() != 2) return false;
      if (!done.insert(start).second) continue;
      std::vector<Index> hole{start};
      for (Index before = start, at = *neighbours.begin(); at != start;) {
        if (hole.size() == kMaxHoleEdges) return false;
        hole.push_back(at);
        done.insert(at);
        const std::set<Index>& next = borders_.at(at);
        if (next.size() != 2) return false;
        const Index to = *next.begin() == before ? *next.rbegin() : *next.begin();
        before = at, at = to;
      }
      holes->push_back(std::move(hole));
    }
    return true;
  }

  // An upright rectangle on the bottom, alone or together with a floor.
  bool IsWall(const std::vector<Index>& hole) const {
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

  void Fill(const std::vector<Index>& hole) {
    std::vector<Point3> ring;
    for (const Index i : hole) ring.push_back(shell_.points[i]);
    for (const auto& [a, b, c] : TriangulatePolygon({ring})) Add({hole[a], hole[b], hole[c]});
  }

  void Add(const std::array<Index, 3>& corners) {
    const Triangle3 t{shell_.points[corners[0]], shell_.points[corners[1]], shell_.points[corners[2]]};
    if (Thickness(t) > kThinTriangle_m) out_.push_back(t);
  }

  Welded shell_;
  Borders borders_;
  std::vector<Triangle3> out_;
};

}  // namespace

std::vector<Triangle3> MissingTriangles(const std::vector<Triangle3>& shell) { return Repair(Weld(shell)).Run(); }

}  // namespace flaneur
