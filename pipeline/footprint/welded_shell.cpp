#include "pipeline/footprint/welded_shell.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "pipeline/footprint/constants.h"

namespace flaneur {
namespace {

bool Before(const Point3& a, const Point3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

// How far along a direction p lies from o; NaN where that is none.
double Along(const Point3& direction, const Point3& o, const Point3& p) {
  const auto& [x, y, z] = direction;
  return (x * (p.x - o.x) + y * (p.y - o.y) + z * (p.z - o.z)) / std::hypot(x, y, z);
}

// The point of each corner of all triangles, one after the other.
std::vector<CornerIndex> WeldCorners(const std::vector<Triangle3>& shell, std::vector<Point3>* points) {
  using Cell = std::array<int64_t, 3>;
  std::vector<std::pair<Cell, CornerIndex>> corners;
  corners.reserve(3 * shell.size());
  for (const Triangle3& t : shell) {
    for (const Point3& p : t) {
      const auto cell = [](double v) { return static_cast<int64_t>(std::llround(v / kSameCorner_m)); };
      corners.emplace_back(Cell{cell(p.x), cell(p.y), cell(p.z)}, static_cast<CornerIndex>(corners.size()));
    }
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

}  // namespace

WeldedShell Weld(const std::vector<Triangle3>& shell) {
  WeldedShell out;
  const std::vector<CornerIndex> point_of = WeldCorners(shell, &out.points);
  std::vector<std::pair<Corners, size_t>> triangles;
  for (size_t i = 0; i < shell.size(); ++i) {
    Corners t{point_of[3 * i], point_of[3 * i + 1], point_of[3 * i + 2]};
    std::sort(t.begin(), t.end());
    if (t[0] != t[1] && t[1] != t[2]) triangles.emplace_back(t, i);
  }
  std::sort(triangles.begin(), triangles.end());
  for (const auto& [corners, i] : triangles) {
    if (!out.triangles.empty() && out.triangles.back() == corners) continue;
    out.triangles.push_back(corners);
    out.source.push_back(i);
  }
  return out;
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
