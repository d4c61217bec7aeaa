#include <algorithm>
#include <cmath>

#include "pipeline/footprint/check_parts.h"
#include "pipeline/footprint/constants.h"

namespace flaneur {
namespace {

using Entry = CheckedObstacle;

struct Gap {
  double width_m;
  Point2 from, to;
};

bool Near(const Entry& entry, Point2 p, double reach) {
  return p.x >= entry.min.x - reach && p.x <= entry.max.x + reach && p.y >= entry.min.y - reach &&
         p.y <= entry.max.y + reach;
}

bool BoxesWithin(const Entry& a, const Entry& b, double reach) {
  return a.min.x <= b.max.x + reach && b.min.x <= a.max.x + reach && a.min.y <= b.max.y + reach &&
         b.min.y <= a.max.y + reach;
}

Point2 NearestOn(Point2 p, Point2 a, Point2 b) {
  const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  const double t = length2 > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0.0, 1.0) : 0;
  return {a.x + t * dx, a.y + t * dy};
}

void AddGap(Point2 p, const Entry& near, double reach, std::vector<Gap>* gaps) {
  if (!Near(near, p, reach)) return;
  Gap best{reach, p, p};
  for (const Ring& ring : near.rings) {
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const Point2 q = NearestOn(p, ring[j], ring[i]);
      const double d = std::hypot(q.x - p.x, q.y - p.y);
      if (d < best.width_m) best = {d, p, q};
    }
  }
  if (best.width_m < reach) gaps->push_back(best);
}

// From a's corners to b, or from points along its edges.
void AddGaps(const Entry& a, const Entry& b, double reach, bool along, std::vector<Gap>* gaps) {
  for (const Ring& ring : a.rings) {
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const Point2 p = ring[j], q = ring[i];
      const double length = std::hypot(q.x - p.x, q.y - p.y);
      const int steps = along ? static_cast<int>(std::ceil(std::min(length / kWallSampleStep_m, 200.0))) : 1;
      for (int s = along ? 1 : 0; s < steps; ++s)
        AddGap({p.x + (q.x - p.x) * s / steps, p.y + (q.y - p.y) * s / steps}, b, reach, gaps);
    }
  }
}

double SideOf(Point2 a, Point2 b, Point2 p) { return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x); }

bool Fills(const Entry& other, const Gap& gap, double tolerance) {
  const Point2 middle{(gap.from.x + gap.to.x) / 2, (gap.from.y + gap.to.y) / 2};
  if (!Near(other, middle, gap.width_m)) return false;
  if (Contains(other.rings, middle) || DistanceToBoundary(other.rings, middle) <= tolerance) return true;
  for (const Ring& ring : other.rings)
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
      if (SideOf(gap.from, gap.to, ring[j]) * SideOf(gap.from, gap.to, ring[i]) < 0 &&
          SideOf(ring[j], ring[i], gap.from) * SideOf(ring[j], ring[i], gap.to) < 0)
        return true;
  return false;
}

class PairCheck {
 public:
  explicit PairCheck(CheckState* state) : state_(*state), grid_(GridOf(state->obstacles)) {
    for (Entry& entry : state->obstacles)
      if (!entry.rings.empty() && !entry.points_missing) sorted_.push_back(&entry);
    std::stable_sort(sorted_.begin(), sorted_.end(),
                     [](const Entry* a, const Entry* b) { return a->min.x < b->min.x; });
  }

  void Run() {
    FindDuplicates();
    std::erase_if(sorted_, [](const Entry* entry) { return entry->duplicate; });
    const double reach = 4 * state_.options.person_radius_m;
    ForEachPair(reach, [&](Entry& a, Entry& b) {
      if (!CheckOverlap(a, b)) CheckGap(a, b, reach);
    });
  }

 private:
  template <typename Function>
  void ForEachPair(double reach, const Function& function) {
    for (size_t i = 0; i < sorted_.size(); ++i) {
      for (size_t j = i + 1; j < sorted_.size() && sorted_[j]->min.x <= sorted_[i]->max.x + reach; ++j) {
        Entry &a = *sorted_[i], &b = *sorted_[j];
        if (!BoxesWithin(a, b, reach)) continue;
        const bool in_order = a.obstacle < b.obstacle;
        function(in_order ? a : b, in_order ? b : a);
      }
    }
  }

  // The later one takes no further part: its overlaps and gaps are those of the first.
  void FindDuplicates() {
    ForEachPair(0, [&](Entry& a, Entry& b) {
      if (a.duplicate || b.duplicate) return;
      const double area_a = Area(a.rings), area_b = Area(b.rings);
      if (std::min(area_a, area_b) < kSameShare * std::max(area_a, area_b)) return;
      const Rings shared = Intersection(a.rings, b.rings);
      const double share = Area(shared) / std::max(area_a, area_b);
      if (share < kSameShare) return;
      b.duplicate = true;
      state_.Add(402, b.obstacle->name, shared[0][0], share, kSameShare, Names(b, a), a.obstacle->name);
    });
  }

  static std::string Names(const Entry& a, const Entry& b) {
    return "'" + a.obstacle->name + "' and '" + b.obstacle->name + "'";
  }

  // A hole that is not where it should be says nothing about what stands in it.
  static bool StandsInBrokenHole(const Entry& inner, const Entry& outer) {
    if (!outer.holes_broken) return false;
    return Contains(outer.obstacle->outer, inner.rings[0][0]);
  }

  bool CheckOverlap(const Entry& a, const Entry& b) {
    if (!BoxesWithin(a, b, 0)) return false;
    if (StandsInBrokenHole(a, b) || StandsInBrokenHole(b, a)) return true;
    Rings shared = Intersection(a.rings, b.rings);
    if (shared.empty()) return false;
    Rings doubt = a.doubt;
    doubt.insert(doubt.end(), b.doubt.begin(), b.doubt.end());
    if (!doubt.empty()) shared = Difference(shared, Offset(UnionOfRings(doubt), state_.options.tolerance_m));
    const double overlap = Area(shared);
    if (overlap <= state_.options.overlap_m2) return false;
    const auto largest = std::max_element(shared.begin(), shared.end(),
                                          [](const Ring& p, const Ring& q) { return SignedArea(p) < SignedArea(q); });
    state_.Add(401, a.obstacle->name, MiddleOf(*largest), overlap, state_.options.overlap_m2,
               Names(a, b) + " share " + SquareMetres(overlap), b.obstacle->name);
    return true;
  }

  static Point2 MiddleOf(const Ring& ring) {
    Point2 sum;
    for (const Point2& p : ring) sum = {sum.x + p.x, sum.y + p.y};
    const double n = static_cast<double>(ring.size());
    return {sum.x / n, sum.y / n};
  }

  // Where a crossing leaves an outline open, so is its distance.
  bool DoubtWithin(const Entry& entry, const Entry& other, double reach) const {
    for (const Ring& hull : entry.doubt)
      for (size_t i = 0, j = hull.size() - 1; i < hull.size(); j = i++)
        if (Near(other, NearestOn({(other.min.x + other.max.x) / 2, (other.min.y + other.max.y) / 2}, hull[j], hull[i]),
                 reach))
          return true;
    return false;
  }

  void CheckGap(const Entry& a, const Entry& b, double reach) {
    if (DoubtWithin(a, b, reach) || DoubtWithin(b, a, reach)) return;
    std::vector<Gap> gaps;
    AddGaps(a, b, reach, false, &gaps);
    AddGaps(b, a, reach, false, &gaps);
    if (gaps.empty()) return;
    const auto narrower = [](const Gap& p, const Gap& q) { return p.width_m < q.width_m; };
    if (std::min_element(gaps.begin(), gaps.end(), narrower)->width_m <= state_.options.tolerance_m) return;
    if (ReportOpenGap(a, b, &gaps)) return;
    gaps.clear();
    AddGaps(a, b, reach, true, &gaps);
    AddGaps(b, a, reach, true, &gaps);
    ReportOpenGap(a, b, &gaps);
  }

  // The narrowest gap that no third obstacle fills.
  bool ReportOpenGap(const Entry& a, const Entry& b, std::vector<Gap>* gaps) {
    std::sort(gaps->begin(), gaps->end(), [](const Gap& p, const Gap& q) { return p.width_m < q.width_m; });
    for (const Gap& gap : *gaps) {
      if (gap.width_m <= state_.options.tolerance_m || IsFilled(a, b, gap)) continue;
      const double passage = 2 * state_.options.person_radius_m;
      const int code = gap.width_m < passage ? 403 : 404;
      state_.Add(code, a.obstacle->name, {(gap.from.x + gap.to.x) / 2, (gap.from.y + gap.to.y) / 2}, gap.width_m,
                 code == 403 ? passage : 2 * passage, Metres(gap.width_m) + " between " + Names(a, b),
                 b.obstacle->name);
      return true;
    }
    return false;
  }

  bool IsFilled(const Entry& a, const Entry& b, const Gap& gap) const {
    if (Fills(a, gap, 0) || Fills(b, gap, 0)) return true;
    const BoundingBox box{{std::min(gap.from.x, gap.to.x), std::min(gap.from.y, gap.to.y)},
                          {std::max(gap.from.x, gap.to.x), std::max(gap.from.y, gap.to.y)}};
    for (const size_t i : grid_.Near(box, gap.width_m)) {
      const Entry* const other = &state_.obstacles[i];
      if (other != &a && other != &b && !other->duplicate && !other->points_missing &&
          Fills(*other, gap, state_.options.tolerance_m))
        return true;
    }
    return false;
  }

  CheckState& state_;
  BoxGrid grid_;
  std::vector<Entry*> sorted_;
};

}  // namespace

void CheckPairs(CheckState* state) { PairCheck(state).Run(); }

}  // namespace flaneur
