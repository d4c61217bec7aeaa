#include <algorithm>
#include <clipper.hpp>
#include <cmath>

#include "pipeline/footprint/check_parts.h"
#include "pipeline/footprint/constants.h"

namespace flaneur {
namespace {

namespace cl = ClipperLib;
constexpr double kUnitsPerMetre = 1e4;

cl::Paths ToPaths(const Rings& rings) {
  cl::Paths paths(rings.size());
  for (size_t i = 0; i < rings.size(); ++i)
    for (const Point2& p : rings[i])
      paths[i].push_back({std::llround(p.x * kUnitsPerMetre), std::llround(p.y * kUnitsPerMetre)});
  return paths;
}

Rings ToRings(const cl::Paths& paths) {
  Rings rings;
  for (const cl::Path& path : paths) {
    if (path.size() < 3) continue;
    Ring& ring = rings.emplace_back();
    for (const cl::IntPoint& p : path)
      ring.push_back({static_cast<double>(p.X) / kUnitsPerMetre, static_cast<double>(p.Y) / kUnitsPerMetre});
  }
  return rings;
}

}  // namespace

Rings OffsetRound(const Rings& rings, double distance_m) {
  cl::ClipperOffset offset(2, kArcTolerance_m * kUnitsPerMetre);
  offset.AddPaths(ToPaths(rings), cl::jtRound, cl::etClosedPolygon);
  cl::Paths out;
  offset.Execute(out, distance_m * kUnitsPerMetre);
  return ToRings(out);
}

Rings NonZeroArea(const Ring& ring) {
  cl::Clipper clipper;
  clipper.StrictlySimple(true);
  clipper.AddPaths(ToPaths({ring}), cl::ptSubject, true);
  cl::Paths out;
  clipper.Execute(cl::ctUnion, out, cl::pftNonZero, cl::pftNonZero);
  return ToRings(out);
}

// Andrew's monotone chain.
Ring ConvexHull(Ring points) {
  std::sort(points.begin(), points.end(), [](Point2 a, Point2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  if (points.size() < 3) return points;
  Ring hull;
  const auto extend = [&](Point2 p, size_t keep) {
    while (hull.size() >= keep + 2) {
      const Point2 a = hull[hull.size() - 2], b = hull.back();
      if ((b.x - a.x) * (p.y - a.y) - (p.x - a.x) * (b.y - a.y) > 0) break;
      hull.pop_back();
    }
    hull.push_back(p);
  };
  for (const Point2& p : points) extend(p, 0);
  const size_t lower = hull.size() - 1;
  for (size_t i = points.size() - 1; i-- > 0;) extend(points[i], lower);
  hull.pop_back();
  return hull;
}

Ring CircleRing(Point2 center, double radius_m) {
  Ring ring;
  for (int i = 0; i < kCircleCorners; ++i) {
    const double angle = 2 * 3.14159265358979323846 * i / kCircleCorners;
    ring.push_back({center.x + radius_m * std::cos(angle), center.y + radius_m * std::sin(angle)});
  }
  return ring;
}

}  // namespace flaneur
