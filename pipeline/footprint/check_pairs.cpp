#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/footprint/check_parts.h"

namespace flaneur {
namespace {

constexpr double kOverlap_m2 = 0.01;
constexpr double kSameShare = 0.99;  // of the area of both: a duplicate

struct Gap { double width_m = 1e300; Point2 at; };

void FromCorners(const Rings& corners, const Rings& edges, double reach, const CheckedObstacle& near, Gap* gap) {
  for (const Ring& ring : corners) {
    for (const Point2& p : ring) {
      if (p.x < near.min.x - reach || p.x > near.max.x + reach || p.y < near.min.y - reach || p.y > near.max.y + reach)
        continue;
      const double d = DistanceToBoundary(edges, p);
      if (d < gap->width_m) *gap = {d, p};
    }
  }
}

// The nearest distance of two boundaries that do not cross is taken at a corner.
Gap FindGap(const CheckedObstacle& a, const CheckedObstacle& b, double reach) {
  Gap gap;
  FromCorners(a.rings, b.rings, reach, b, &gap);
  FromCorners(b.rings, a.rings, reach, a, &gap);
  return gap;
}

void CheckPair(const CheckedObstacle& a, const CheckedObstacle& b, CheckState* state) {
  const double passage = 2 * state->options.person_radius_m;
  const std::string &name = a.obstacle->name, &other = b.obstacle->name;
  const bool boxes_meet = a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y;
  if (boxes_meet) {
    const Rings shared = Intersection(a.rings, b.rings);
    const double overlap = Area(shared);
    const double larger = std::max(Area(a.rings), Area(b.rings));
    if (overlap > kOverlap_m2 || overlap >= kSameShare * larger) {
      const Point2 at = shared[0][0];
      const std::string detail = "'" + name + "' and '" + other + "'";
      if (overlap >= kSameShare * larger) return state->Add(402, name, at, overlap / larger, kSameShare, detail, other);
      return state->Add(401, name, at, overlap, kOverlap_m2, detail, other);
    }
  }
  const Gap gap = FindGap(a, b, 2 * passage);
  if (gap.width_m <= state->options.tolerance_m || gap.width_m >= 2 * passage) return;
  const int code = gap.width_m < passage ? 403 : 404;
  state->Add(code, name, gap.at, gap.width_m, code == 403 ? passage : 2 * passage,
             Metres(gap.width_m) + " between '" + name + "' and '" + other + "'", other);
}

}  // namespace

void CheckPairs(CheckState* state) {
  const double reach = 4 * state->options.person_radius_m;
  std::vector<const CheckedObstacle*> sorted;
  for (const CheckedObstacle& entry : state->obstacles)
    if (entry.sound) sorted.push_back(&entry);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const CheckedObstacle* a, const CheckedObstacle* b) { return a->min.x < b->min.x; });
  for (size_t i = 0; i < sorted.size(); ++i) {
    for (size_t j = i + 1; j < sorted.size() && sorted[j]->min.x <= sorted[i]->max.x + reach; ++j) {
      const CheckedObstacle &a = *sorted[i], &b = *sorted[j];
      if (a.min.y > b.max.y + reach || b.min.y > a.max.y + reach) continue;
      const bool in_order = a.obstacle < b.obstacle;
      CheckPair(in_order ? a : b, in_order ? b : a, state);
    }
  }
}

}  // namespace flaneur
