#include "pipeline/io/triangulate_polygon.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "runtime/base/array.h"

namespace flaneur {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
constexpr uint32_t kNoPoint = UINT32_MAX;
struct VertexInfo {
  uint32_t point = kNoPoint;
};
struct FaceInfo {
  int depth = -1;
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<VertexInfo, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::Exact_predicates_tag>;
using Face = Triangulation::Face_handle;
using Vertex = Triangulation::Vertex_handle;

// Newell's normal, twice the area long. Relative to the first point, so that large coordinates lose nothing.
Point3 Normal(const std::vector<Point3>& ring) {
  Point3 n;
  const Point3 o = ring[0];
  for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Point3 a{ring[j].x - o.x, ring[j].y - o.y, ring[j].z - o.z},
        b{ring[i].x - o.x, ring[i].y - o.y, ring[i].z - o.z};
    n.x += a.y * b.z - a.z * b.y;
    n.y += a.z * b.x - a.x * b.z;
    n.z += a.x * b.y - a.y * b.x;
  }
  return n;
}

// Two of the three coordinates, in the order that keeps the first ring anticlockwise.
struct Plane {
  int axis;
  bool turned;
  Kernel::Point_2 operator()(const Point3& p, const Point3& o) const {
    const double x = p.x - o.x, y = p.y - o.y, z = p.z - o.z;
    double u = axis == 0 ? y : axis == 1 ? z : x, v = axis == 0 ? z : axis == 1 ? x : y;
    if (turned) std::swap(u, v);
    return {u, v};
  }
};

std::optional<Plane> MainPlane(const std::vector<Point3>& ring) {
  const Point3 n = Normal(ring);
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  if (!(x + y + z > 0)) return std::nullopt;
  if (x >= y && x >= z) return Plane{0, n.x < 0};
  if (y >= z) return Plane{1, n.y < 0};
  return Plane{2, n.z < 0};
}

void Flood(Triangulation* triangulation) {
  std::vector<Face> queue{triangulation->infinite_face()}, next;
  for (int depth = 0; !queue.empty(); ++depth, queue.swap(next), next.clear()) {
    while (!queue.empty()) {
      const Face face = queue.back();
      queue.pop_back();
      if (face->info().depth >= 0) continue;
      face->info().depth = depth;
      for (int i = 0; i < 3; ++i) {
        const Face other = face->neighbor(i);
        if (other->info().depth < 0) (face->is_constrained(i) ? next : queue).push_back(other);
      }
    }
  }
}

std::vector<Kernel::Point_2> Flat(const std::vector<std::vector<Point3>>& rings, const Plane& plane) {
  std::vector<Kernel::Point_2> points;
  for (const std::vector<Point3>& ring : rings)
    for (const Point3& p : ring) points.push_back(plane(p, rings[0][0]));
  return points;
}

std::vector<Vertex> Insert(const std::vector<Kernel::Point_2>& points, Triangulation* triangulation) {
  std::vector<Vertex> vertices;
  for (size_t i = 0; i < points.size(); ++i) {
    vertices.push_back(triangulation->insert(points[i], vertices.empty() ? Face() : vertices.back()->face()));
    VertexInfo& info = vertices.back()->info();
    if (info.point == kNoPoint) info.point = static_cast<uint32_t>(i);
  }
  return vertices;
}

// Where rings cross, the nearest of the polygon's own points stands for the crossing.
uint32_t PointOf(Vertex v, const std::vector<Kernel::Point_2>& points) {
  if (v->info().point != kNoPoint) return v->info().point;
  const auto nearer = [&](const Kernel::Point_2& p, const Kernel::Point_2& q) {
    return CGAL::compare_distance_to_point(v->point(), p, q) == CGAL::SMALLER;
  };
  v->info().point = static_cast<uint32_t>(std::min_element(points.begin(), points.end(), nearer) - points.begin());
  return v->info().point;
}

// A scribble rather than a polygon: what crosses itself everywhere has as many corners as the square of its points.
bool CrossesTooOften(size_t points, size_t vertices) {
  constexpr size_t kFree = 100, kForEachPoint = 10, kMostComparisons = 50000000;
  const size_t crossings = vertices > points ? vertices - points : 0;
  return crossings > kFree + kForEachPoint * points || crossings * points > kMostComparisons;
}

bool IsTriangle(const std::vector<std::vector<Point3>>& rings) { return rings.size() == 1 && rings[0].size() == 3; }

// A convex quad, split at its shorter diagonal.
bool SplitQuad(const std::vector<std::vector<Point3>>& rings, const Plane& plane,
               std::vector<std::array<uint32_t, 3>>* out) {
  if (rings.size() != 1 || rings[0].size() != 4) return false;
  std::array<Kernel::Point_2, 4> p;
  for (size_t i = 0; i < 4; ++i) p[i] = plane(rings[0][i], rings[0][0]);
  for (size_t i = 0; i < 4; ++i)
    if (CGAL::orientation(p[i], p[(i + 1) % 4], p[(i + 2) % 4]) != CGAL::LEFT_TURN) return false;
  if (CGAL::squared_distance(p[0], p[2]) <= CGAL::squared_distance(p[1], p[3])) *out = {{0, 1, 2}, {0, 2, 3}};
  else *out = {{0, 1, 3}, {1, 2, 3}};
  return true;
}

}  // namespace

std::vector<std::array<uint32_t, 3>> TriangulatePolygon(const std::vector<std::vector<Point3>>& rings) {
  std::vector<std::array<uint32_t, 3>> out;
  if (rings.empty() || rings[0].size() < 3) return out;
  if (IsTriangle(rings)) return {{0, 1, 2}};
  const std::optional<Plane> plane = MainPlane(rings[0]);
  if (!plane || SplitQuad(rings, *plane, &out)) return out;
  const std::vector<Kernel::Point_2> points = Flat(rings, *plane);
  Triangulation triangulation;
  const std::vector<Vertex> vertices = Insert(points, &triangulation);
  size_t first = 0;
  for (const std::vector<Point3>& ring : rings) {
    for (size_t i = 0; i < ring.size(); ++i) {
      const Vertex a = vertices[first + i], b = vertices[first + (i + 1) % ring.size()];
      if (a != b) triangulation.insert_constraint(a, b);
      if (CrossesTooOften(points.size(), triangulation.number_of_vertices())) return out;
    }
    first += ring.size();
  }
  Flood(&triangulation);
  for (const Face face : triangulation.finite_face_handles()) {
    if (face->info().depth % 2 == 0) continue;
    std::array<uint32_t, 3> t;
    for (int i = 0; i < 3; ++i) At(t, i) = PointOf(face->vertex(i), points);
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) out.push_back(t);
  }
  return out;
}

}  // namespace flaneur
