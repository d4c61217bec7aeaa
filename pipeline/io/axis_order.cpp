#include "pipeline/io/axis_order.h"

#include <cmath>

namespace flaneur {
namespace {

constexpr double kRight = 0.01;           // the cosine of an angle that counts as right
constexpr double kAlong = 0.002;          // an edge this near to a meridian or parallel tells nothing
constexpr double kMinEdge_m = 0.5;        // shorter edges are rounded too much
constexpr int kMinRight = 12;             // fewer are chance
constexpr double kClearly = 1.5;          // so many times more of them
constexpr double kDegree_m = 111'319.49;  // of the equator

Point2 EdgeIn_m(Point2 a, Point2 b, double unit_deg) {
  constexpr double kRadian = 3.14159265358979323846 / 180, kEccentricity2 = 0.00669438;
  const double latitude = a.y * unit_deg * kRadian, degree_m = kDegree_m * unit_deg;
  const double s = std::sin(latitude), c = std::cos(latitude), w = 1 - kEccentricity2 * s * s;
  return {(b.x - a.x) * degree_m * c / std::sqrt(w),
          (b.y - a.y) * degree_m * (1 - kEccentricity2) / (w * std::sqrt(w))};
}

}  // namespace

Corners CornersOf(const std::vector<PlanRing>& rings, double unit_deg) {
  Corners corners;
  for (const PlanRing& ring : rings) {
    for (size_t i = 0, n = ring.size(); n >= 3 && i < n; ++i) {
      const Point2 u = EdgeIn_m(ring[(i + n - 1) % n], ring[i], unit_deg);
      const Point2 v = EdgeIn_m(ring[i], ring[(i + 1) % n], unit_deg);
      const double lu = std::hypot(u.x, u.y), lv = std::hypot(v.x, v.y);
      if (!(lu > kMinEdge_m && lv > kMinEdge_m)) continue;
      if (std::abs(u.x) < kAlong * lu || std::abs(u.y) < kAlong * lu) continue;
      ++corners.all;
      corners.right += std::abs(u.x * v.x + u.y * v.y) < kRight * lu * lv;
    }
  }
  return corners;
}

AxisEvidence AxesByRightAngles(const std::vector<PlanRing>& rings, double unit_deg) {
  std::vector<PlanRing> swapped = rings;
  for (PlanRing& ring : swapped)
    for (Point2& p : ring) p = {p.y, p.x};
  const int given = CornersOf(rings, unit_deg).right, turned = CornersOf(swapped, unit_deg).right;
  if (given >= kMinRight && given > kClearly * turned) return AxisEvidence::kAsGiven;
  if (turned >= kMinRight && turned > kClearly * given) return AxisEvidence::kSwapped;
  return AxisEvidence::kNone;
}

}  // namespace flaneur
