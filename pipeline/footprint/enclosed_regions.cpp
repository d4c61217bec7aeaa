#include "pipeline/footprint/enclosed_regions.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>

#include <algorithm>
#include <map>

#include "pipeline/footprint/constants.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

// Where segments meet only at their ends nothing has to be constructed, and predicates alone must be exact.
using Plain = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;

template <typename Kernel, typename Crossings>
struct Triangulated {
  using VertexBase = CGAL::Triangulation_vertex_base_2<Kernel>;
  using FaceBase =
      CGAL::Triangulation_face_base_with_info_2<int, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
  using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
  using Type = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, Crossings>;
};
using PlainTriangulation = Triangulated<Plain, CGAL::No_constraint_intersection_requiring_constructions_tag>::Type;
using ExactTriangulation = Triangulated<Exact, CGAL::Exact_intersections_tag>::Type;

// A triangle larger than this is sampled at several points.

template <typename Triangulation>
void Triangulate(const std::vector<Segment>& segments, Triangulation* triangulation) {
  std::vector<typename Triangulation::Point> points;
  std::vector<std::pair<size_t, size_t>> edges;
  std::map<std::pair<double, double>, size_t> index;
  const auto vertex = [&](Point2 p) {
    const auto [entry, is_new] = index.try_emplace({p.x, p.y}, points.size());
    if (is_new) points.emplace_back(p.x, p.y);
    return entry->second;
  };
  for (const Segment& s : segments) {
    const size_t a = vertex(s.a);
    edges.emplace_back(a, vertex(s.b));
  }
  triangulation->insert_constraints(points.begin(), points.end(), edges.begin(), edges.end());
}

template <typename Face>
void Flood(Face start, int region) {
  std::vector<Face> queue{start};
  start->info() = region;
  while (!queue.empty()) {
    const Face face = queue.back();
    queue.pop_back();
    for (int i = 0; i < 3; ++i) {
      const Face next = face->neighbor(i);
      if (face->is_constrained(i) || next->info() >= 0) continue;
      next->info() = region;
      queue.push_back(next);
    }
  }
}

template <typename Vertex>
Point2 ToPoint(Vertex v) {
  return {CGAL::to_double(v->point().x()), CGAL::to_double(v->point().y())};
}

struct Region {
  double area_m2 = 0;
  std::vector<RegionSample> samples;
};

template <typename Face>
void AddSamples(Face face, Region* region) {
  const Point2 a = ToPoint(face->vertex(0)), b = ToPoint(face->vertex(1)), c = ToPoint(face->vertex(2));
  const double area = SignedArea({a, b, c});
  region->area_m2 += area;
  const Point2 m{(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3};
  if (area <= kRoofSampleArea_m2) return region->samples.push_back({m, area});
  region->samples.push_back({m, area / 4});
  for (const Point2 p : {a, b, c}) region->samples.push_back({{(m.x + p.x) / 2, (m.y + p.y) / 2}, area / 4});
}

// Numbers the regions from 0, the outside.
template <typename Triangulation>
std::vector<Region> FindRegions(Triangulation* triangulation) {
  for (const typename Triangulation::Face_handle face : triangulation->all_face_handles()) face->info() = -1;
  Flood(triangulation->infinite_face(), 0);
  std::vector<Region> regions(1);
  for (const typename Triangulation::Face_handle face : triangulation->finite_face_handles()) {
    if (face->info() == 0) continue;
    if (face->info() < 0) {
      Flood(face, Count(regions));
      regions.emplace_back();
    }
    AddSamples(face, &At(regions, face->info()));
  }
  return regions;
}

// Walks along the edges with something solid on their left.
template <typename Triangulation>
Rings TraceSolid(const Triangulation& triangulation, const std::vector<bool>& solid) {
  using Vertex = typename Triangulation::Vertex_handle;
  std::map<Vertex, std::vector<Vertex>> next;
  std::vector<Vertex> starts;
  for (const typename Triangulation::Face_handle face : triangulation.finite_face_handles()) {
    if (!At(solid, face->info())) continue;
    for (int i = 0; i < 3; ++i) {
      if (At(solid, face->neighbor(i)->info())) continue;
      const Vertex from = face->vertex(Triangulation::ccw(i));
      next[from].push_back(face->vertex(Triangulation::cw(i)));
      starts.push_back(from);
    }
  }
  Rings rings;
  for (const Vertex start : starts) {
    Ring ring;
    for (Vertex v = start; !next[v].empty();) {
      ring.push_back(ToPoint(v));
      const Vertex to = next[v].back();
      next[v].pop_back();
      v = to;
    }
    if (ring.size() >= 3) rings.push_back(std::move(ring));
  }
  return Union(rings, {});
}

template <typename Triangulation>
EnclosedRegions Enclose(const std::vector<Segment>& cut, const RegionTest& is_solid) {
  Triangulation triangulation;
  Triangulate(cut, &triangulation);
  if (triangulation.dimension() < 2) return {{}, cut};
  const std::vector<Region> regions = FindRegions(&triangulation);
  std::vector<bool> solid(regions.size(), false);
  for (size_t i = 1; i < regions.size(); ++i) solid[i] = is_solid(regions[i].area_m2, regions[i].samples);
  EnclosedRegions out;
  out.solid = TraceSolid(triangulation, solid);
  for (const auto& [face, i] : triangulation.finite_edges()) {
    const auto is_solid_face = [&](const auto& f) { return At(solid, f->info()); };
    if (face->is_constrained(i) && !is_solid_face(face) && !is_solid_face(face->neighbor(i)))
      out.loose.push_back({ToPoint(face->vertex(Triangulation::ccw(i))), ToPoint(face->vertex(Triangulation::cw(i)))});
  }
  return out;
}

}  // namespace

EnclosedRegions EncloseRegions(const std::vector<Segment>& segments, const RegionTest& is_solid) {
  if (segments.empty()) return {};
  try {
    return Enclose<PlainTriangulation>(segments, is_solid);
  } catch (const PlainTriangulation::Intersection_of_constraints_exception&) {
    return Enclose<ExactTriangulation>(segments, is_solid);
  }
}

}  // namespace flaneur
