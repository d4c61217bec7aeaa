#include "pipeline/footprint/welded_shell.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "pipeline/footprint/constants.h"

namespace flaneur {
namespace {

bool Before(const Point3& a, const Point3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

// How far along a direction p lies from o; NaN where that is none.
double Along(const Point3& direction, const Point3& o, const Point3& p) {
  const auto& [x, y, z] = direction;
  return (x * (p.x - o.x) + y * (p.y - o.y) + z * (p.z - o.z)) / std::hypot(x, y, z);
}

using Cell = std::array<int64_t, 3>;

struct HashOfCell {
  size_t operator()(const Cell& c) const {
    size_t hash = 0;
    for (const int64_t v : c) hash = (hash ^ static_cast<size_t>(v)) * 0x9e3779b97f4a7c15u, hash ^= hash >> 32;
    return hash;
  }
};

Cell CellOf(const Point3& p, double cell_m) {
  const auto cell = [cell_m](double v) { return static_cast<int64_t>(std::llround(v / cell_m)); };
  return {cell(p.x), cell(p.y), cell(p.z)};
}

// The point of each corner of all triangles, one after the other.
std::vector<CornerIndex> WeldCorners(const std::vector<Triangle3>& shell, std::vector<Point3>* points) {
  std::vector<std::pair<Cell, CornerIndex>> corners;
  corners.reserve(3 * shell.size());
  for (const Triangle3& t : shell) {
    for (const Point3& p : t) corners.emplace_back(CellOf(p, kSameCorner_m), static_cast<CornerIndex>(corners.size()));
  }
  std::sort(corners.begin(), corners.end());
  std::vector<CornerIndex> point_of(corners.size());
  for (size_t i = 0; i < corners.size(); ++i) {
    const CornerIndex corner = corners[i].second;
    const Point3& at = shell[corner / 3][corner % 3];
    if (i == 0 || corners[i].first != corners[i - 1].first) points->push_back(at);
    else if (Before(at, points->back())) points->back() = at;
    point_of[corner] = static_cast<CornerIndex>(points->size() - 1);
  }
  return point_of;
}

// Each once; those that are a line or a point vanish.
void SetTriangles(const std::vector<CornerIndex>& point_of, WeldedShell* shell) {
  std::vector<std::pair<Corners, size_t>> triangles;
  for (size_t i = 0; 3 * i < point_of.size(); ++i) {
    Corners t{point_of[3 * i], point_of[3 * i + 1], point_of[3 * i + 2]};
    std::sort(t.begin(), t.end());
    if (t[0] != t[1] && t[1] != t[2]) triangles.emplace_back(t, i);
  }
  std::sort(triangles.begin(), triangles.end());
  shell->triangles.clear(), shell->source.clear();
  for (const auto& [corners, i] : triangles) {
    if (!shell->triangles.empty() && shell->triangles.back() == corners) continue;
    shell->triangles.push_back(corners);
    shell->source.push_back(i);
  }
}

std::vector<BorderEdge> FindBorderEdges(const WeldedShell& shell) {
  std::vector<BorderEdge> edges;
  edges.reserve(3 * shell.triangles.size());
  for (size_t i = 0; i < shell.triangles.size(); ++i) {
    const auto& [a, b, c] = shell.triangles[i];
    for (const CornerEdge& edge : {CornerEdge{a, b}, CornerEdge{b, c}, CornerEdge{a, c}}) edges.push_back({edge, i});
  }
  std::sort(edges.begin(), edges.end(), [](const BorderEdge& s, const BorderEdge& t) {
    return std::tie(s.edge, s.triangle) < std::tie(t.edge, t.triangle);
  });
  std::vector<BorderEdge> borders;
  for (size_t i = 0, next; i < edges.size(); i = next) {
    for (next = i + 1; next < edges.size() && edges[next].edge == edges[i].edge;) ++next;
    if (next == i + 1) borders.push_back(edges[i]);
  }
  return borders;
}

// Points in the cells of a grid, so wide that few have neighbours in more than one.
class PointGrid {
 public:
  explicit PointGrid(const std::vector<Point3>& points) : points_(points), next_(points.size(), kNone) {}

  void Add(CornerIndex i) {
    const auto [head, is_new] = heads_.try_emplace(CellOf(points_[i]), i);
    if (!is_new) next_[i] = head->second, head->second = i;
  }
  // The nearest that was added, if it is nearer than most_m, else p itself.
  CornerIndex NearestTo(CornerIndex p, double most_m) const {
    const Point3& at = points_[p];
    const Cell low = CellOf({at.x - most_m, at.y - most_m, at.z - most_m});
    const Cell high = CellOf({at.x + most_m, at.y + most_m, at.z + most_m});
    CornerIndex nearest = p;
    for (int64_t x = low[0]; x <= high[0]; ++x)
      for (int64_t y = low[1]; y <= high[1]; ++y)
        for (int64_t z = low[2]; z <= high[2]; ++z) {
          const auto head = heads_.find({x, y, z});
          for (CornerIndex i = head == heads_.end() ? kNone : head->second; i != kNone; i = next_[i]) {
            const double distance_m = Distance(at, points_[i]);
            if (distance_m < most_m) nearest = i, most_m = distance_m;
          }
        }
    return nearest;
  }

 private:
  static constexpr CornerIndex kNone = std::numeric_limits<CornerIndex>::max();
  static Cell CellOf(const Point3& p) { return flaneur::CellOf(p, 4 * kTornCorner_m); }

  const std::vector<Point3>& points_;
  std::unordered_map<Cell, CornerIndex, HashOfCell> heads_;  // of chains
  std::vector<CornerIndex> next_;
};

// Of each point the one that it is one with: of those on borders the first nearby. No chains of them, so that a fine
// mesh is not drawn together.
std::vector<CornerIndex> JoinTorn(const WeldedShell& shell) {
  std::vector<CornerIndex> torn, joined(shell.points.size());
  std::iota(joined.begin(), joined.end(), CornerIndex{0});
  for (const BorderEdge& border : shell.borders) torn.insert(torn.end(), {border.edge.first, border.edge.second});
  std::sort(torn.begin(), torn.end());
  torn.erase(std::unique(torn.begin(), torn.end()), torn.end());
  PointGrid kept(shell.points);
  for (const CornerIndex i : torn) {
    joined[i] = kept.NearestTo(i, kTornCorner_m);
    if (joined[i] == i) kept.Add(i);
  }
  return joined;
}

}  // namespace

WeldedShell Weld(const std::vector<Triangle3>& shell) {
  WeldedShell out;
  std::vector<CornerIndex> point_of = WeldCorners(shell, &out.points);
  SetTriangles(point_of, &out);
  out.borders = FindBorderEdges(out);
  if (out.borders.empty()) return out;
  const std::vector<CornerIndex> joined = JoinTorn(out);
  bool any = false;
  for (CornerIndex& point : point_of) any |= joined[point] != point, point = joined[point];
  if (!any) return out;
  SetTriangles(point_of, &out);
  out.borders = FindBorderEdges(out);
  return out;
}

size_t TriangleAt(const std::vector<BorderEdge>& edges, CornerIndex a, CornerIndex b) {
  const CornerEdge edge{std::min(a, b), std::max(a, b)};
  const auto before = [](const BorderEdge& e, const CornerEdge& of) { return e.edge < of; };
  return std::lower_bound(edges.begin(), edges.end(), edge, before)->triangle;
}

Borders ToBorders(const std::vector<BorderEdge>& edges) {
  Borders borders;
  for (const BorderEdge& border : edges) {
    borders[border.edge.first].insert(border.edge.second);
    borders[border.edge.second].insert(border.edge.first);
  }
  return borders;
}

void RemoveBorder(CornerIndex a, CornerIndex b, Borders* borders) {
  for (const auto& [from, to] : {CornerEdge{a, b}, CornerEdge{b, a}}) {
    const auto entry = borders->find(from);
    if (entry == borders->end()) continue;
    entry->second.erase(to);
    if (entry->second.empty()) borders->erase(entry);
  }
}

double Distance(const Point3& a, const Point3& b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

Point3 NormalOf(const Triangle3& t) {
  const auto& [a, b, c] = t;
  return {(b.y - a.y) * (c.z - a.z) - (b.z - a.z) * (c.y - a.y), (b.z - a.z) * (c.x - a.x) - (b.x - a.x) * (c.z - a.z),
          (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)};
}

bool GoesOnIn(const Triangle3& triangle, const Triangle3& plane) {
  const Point3 normal = NormalOf(plane);
  return std::all_of(triangle.begin(), triangle.end(),
                     [&](const Point3& p) { return std::abs(Along(normal, plane[0], p)) <= kFlatHole_m; });
}

bool IsPlane(const std::vector<Point3>& ring) {
  Point3 normal{0, 0, 0};
  for (size_t i = 1; i + 1 < ring.size(); ++i) {
    const Point3 n = NormalOf({ring[0], ring[i], ring[i + 1]});
    normal = {normal.x + n.x, normal.y + n.y, normal.z + n.z};
  }
  return std::all_of(ring.begin(), ring.end(),
                     [&](const Point3& p) { return std::abs(Along(normal, ring[0], p)) <= kFlatHole_m; });
}

double ThicknessOf(const Triangle3& t) {
  const Point3 n = NormalOf(t);
  const double longest = std::max({Distance(t[0], t[1]), Distance(t[1], t[2]), Distance(t[2], t[0])});
  return longest > 0 ? std::hypot(n.x, n.y, n.z) / longest : 0;
}

}  // namespace flaneur
