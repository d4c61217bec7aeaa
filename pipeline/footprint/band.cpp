#include "pipeline/footprint/band.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/segment_grid.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

bool Before(const Point3& a, const Point3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }
bool Before(Point2 a, Point2 b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); }
bool Before(const Segment& s, const Segment& t) {
  return std::tie(s.a.x, s.a.y, s.b.x, s.b.y) < std::tie(t.a.x, t.a.y, t.b.x, t.b.y);
}
bool Same(Point2 a, Point2 b) { return a.x == b.x && a.y == b.y; }

// Interpolates from the lesser point, so that an edge gives the same point in both directions.
Point3 Between(Point3 a, Point3 b, double t) {
  if (Before(b, a)) std::swap(a, b), t = 1 - t;
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

double Snap(double value) { return std::round(value / kBandGrid_m) * kBandGrid_m; }
Point2 Snap(Point2 p) { return {Snap(p.x), Snap(p.y)}; }

// Cuts a polygon whose z is the height over the ground: keeps sign * (z - level) >= 0.
std::vector<Point3> CutAt(const std::vector<Point3>& polygon, double level, double sign) {
  std::vector<Point3> out;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Point3& a = polygon[i];
    const Point3& b = polygon[(i + 1) % polygon.size()];
    const bool keep_a = sign * (a.z - level) >= 0, keep_b = sign * (b.z - level) >= 0;
    if (keep_a) out.push_back(a);
    if (keep_a == keep_b) continue;
    const bool forward = Before(a, b);
    const Point3& low = forward ? a : b;
    const Point3& high = forward ? b : a;
    Point3 p = Between(low, high, (level - low.z) / (high.z - low.z));
    p.z = level;
    out.push_back(p);
  }
  return out;
}

// Merges segments that overlap along one line, as do the parts in the band of triangles of one wall: each becomes
// longer by those that overlap its ends, and takes in what lies beside it.
class LineMerger {
 public:
  explicit LineMerger(const std::vector<Segment>& segments)
      : segments_(segments), grid_(segments, kOnLongerLine_m, CellFor(segments)), gone_(segments.size(), false) {}

  std::vector<Segment> Run() {
    std::vector<size_t> order(segments_.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::vector<double> length;
    for (const Segment& s : segments_) length.push_back(Length(s));
    std::stable_sort(order.begin(), order.end(), [&](size_t i, size_t j) { return length[i] > length[j]; });
    std::vector<Segment> out;
    for (const size_t i : order) {
      if (gone_[i]) continue;
      gone_[i] = true;
      out.push_back(Merge(segments_[i]));
    }
    return out;
  }

 private:
  Segment Merge(Segment s) {
    members_ = {s};
    while (Grow(&s)) {}
    const int steps = grid_.one_cell() ? 1 : static_cast<int>(std::ceil(Length(s) / grid_.cell_m()));
    for (int k = 0; k <= steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      for (const size_t j : grid_.Near({s.a.x + share * (s.b.x - s.a.x), s.a.y + share * (s.b.y - s.a.y)}))
        if (!gone_[j] && IsBeside(segments_[j], s)) gone_[j] = true;
    }
    return s;
  }

  bool Grow(Segment* s) {
    for (const Point2 end : {s->a, s->b}) {
      for (const size_t j : grid_.Near(end)) {
        const Segment& t = segments_[j];
        if (gone_[j] || DistanceToSegment(end, t.a, t.b) > kOnLongerLine_m) continue;
        const Segment longer = Together(*s, t);
        if (Length(longer) > Length(*s) + Length(t) - kMinLineOverlap_m || !IsBeside(t, longer)) continue;
        if (!std::all_of(members_.begin(), members_.end(), [&](const Segment& m) { return IsBeside(m, longer); }))
          continue;
        gone_[j] = true;
        members_.push_back(t);
        *s = longer;
        return true;
      }
    }
    return false;
  }

  static bool IsBeside(const Segment& t, const Segment& s) {
    return DistanceToSegment(t.a, s.a, s.b) <= kOnLongerLine_m && DistanceToSegment(t.b, s.a, s.b) <= kOnLongerLine_m;
  }

  // The two ends furthest apart.
  static Segment Together(const Segment& s, const Segment& t) {
    Segment longest = s;
    for (const Segment& other : {t, Segment{s.a, t.a}, Segment{s.a, t.b}, Segment{s.b, t.a}, Segment{s.b, t.b}})
      if (Length(other) > Length(longest)) longest = other;
    return longest;
  }

  const std::vector<Segment>& segments_;
  const SegmentGrid grid_;
  std::vector<bool> gone_;
  std::vector<Segment> members_;  // of the line that grows
};

std::vector<Segment> Merged(const std::vector<Segment>& segments) {
  if (segments.size() < 2) return segments;
  std::vector<Segment> merged = LineMerger(segments).Run();
  for (Segment& s : merged)
    if (Before(s.b, s.a)) std::swap(s.a, s.b);
  std::sort(merged.begin(), merged.end(), [](const Segment& s, const Segment& t) { return Before(s, t); });
  return merged;
}

class BandCutter {
 public:
  BandCutter(const LocalGround& ground, const std::array<double, 2>& band_m) : ground_(ground), band_m_(band_m) {}

  void Add(const Triangle3& t, int depth = 0) {
    const auto [low, high] = std::minmax({t[0].z, t[1].z, t[2].z});
    if (low > ground_.max_height() + band_m_[1] || high < ground_.min_height() + band_m_[0]) return;
    const auto [west, east] = std::minmax({t[0].x, t[1].x, t[2].x});
    const auto [south, north] = std::minmax({t[0].y, t[1].y, t[2].y});
    const auto [lowest, highest] = ground_.Range({west, south}, {east, north});
    if (low > highest + band_m_[1] || high < lowest + band_m_[0]) return;
    if (highest - lowest <= kMaxBend_m) return AddFlat(t);
    int longest = -1;
    double length = kMinSplitEdge_m;
    for (int i = 0; i < 3; ++i) {
      const Point3& a = At(t, i);
      const Point3& b = At(t, (i + 1) % 3);
      const double l = std::hypot(b.x - a.x, b.y - a.y);
      if (l > length && GroundBends(a, b)) longest = i, length = l;
    }
    if (longest < 0 || depth > 24) return AddFlat(t);
    const Point3& a = At(t, longest);
    const Point3& b = At(t, (longest + 1) % 3);
    const Point3& c = At(t, (longest + 2) % 3);
    const Point3 m = Between(a, b, 0.5);
    Add({a, m, c}, depth + 1);
    Add({m, b, c}, depth + 1);
  }

  bool any() const { return !parts_.walls.empty() || !parts_.areas.empty(); }

  BandParts Finish() {
    std::sort(parts_.walls.begin(), parts_.walls.end(),
              [](const Segment& s, const Segment& t) { return Before(s, t); });
    const auto same = [](const Segment& s, const Segment& t) { return Same(s.a, t.a) && Same(s.b, t.b); };
    parts_.walls.erase(std::unique(parts_.walls.begin(), parts_.walls.end(), same), parts_.walls.end());
    parts_.walls = Merged(parts_.walls);
    parts_.areas = UnionOfRings(parts_.areas);
    return std::move(parts_);
  }

 private:
  bool GroundBends(const Point3& a, const Point3& b) const {
    if (ground_.max_height() - ground_.min_height() <= kMaxBend_m) return false;
    const double from = ground_.Height(a.x, a.y), to = ground_.Height(b.x, b.y);
    for (const double t : {0.25, 0.5, 0.75}) {
      const Point3 p = Between(a, b, t);
      const double share = Before(b, a) ? 1 - t : t;
      const double straight = Before(b, a) ? to + share * (from - to) : from + share * (to - from);
      if (std::abs(ground_.Height(p.x, p.y) - straight) > kMaxBend_m) return true;
    }
    return false;
  }

  void AddFlat(const Triangle3& t) {
    std::vector<Point3> part;
    for (const Point3& p : t) part.push_back({p.x, p.y, p.z - ground_.Height(p.x, p.y)});
    part = CutAt(part, band_m_[0], 1);
    if (part.size() >= 2) part = CutAt(part, band_m_[1], -1);
    if (part.size() >= 2) Project(part);
  }

  void Project(const std::vector<Point3>& part) {
    Ring ring;
    for (const Point3& p : part) {
      const Point2 q = Snap({p.x, p.y});
      if (ring.empty() || !Same(ring.back(), q)) ring.push_back(q);
    }
    // The two points furthest apart, and how far the others lie from their line.
    size_t first = 0, last = 0;
    double width = -1;
    for (size_t i = 0; i < ring.size(); ++i) {
      for (size_t j = 0; j < ring.size(); ++j) {
        if (!Before(ring[i], ring[j])) continue;
        const double d = std::hypot(ring[j].x - ring[i].x, ring[j].y - ring[i].y);
        if (d > width || (d == width && Before(Segment{ring[i], ring[j]}, Segment{ring[first], ring[last]})))
          width = d, first = i, last = j;
      }
    }
    if (width <= 0) return;
    double thickness = 0;
    for (const Point2& p : ring) thickness = std::max(thickness, DistanceToSegment(p, ring[first], ring[last]));
    if (thickness <= kThinPart_m) return Draw(ring[first], ring[last]);
    parts_.areas.push_back(std::move(ring));
  }

  void Draw(Point2 a, Point2 b) {
    if (Same(a, b)) return;
    if (Before(b, a)) std::swap(a, b);
    parts_.walls.push_back({a, b});
  }

  const LocalGround& ground_;
  const std::array<double, 2> band_m_;
  BandParts parts_;
};

}  // namespace

std::vector<Segment> Lines(const BandParts& parts) {
  std::vector<Segment> lines = Outside(parts.walls, parts.areas);
  const std::vector<Segment> outline = Outline(parts.areas);
  lines.insert(lines.end(), outline.begin(), outline.end());
  return lines;
}

BandParts CutToBand(const std::vector<Triangle3>& triangles, const LocalGround& ground,
                    const std::array<double, 2>& band_m) {
  BandCutter cutter(ground, band_m);
  for (const Triangle3& t : triangles) cutter.Add(t);
  return cutter.Finish();
}

bool AnyInBand(const std::vector<Triangle3>& triangles, const LocalGround& ground,
               const std::array<double, 2>& band_m) {
  BandCutter cutter(ground, band_m);
  return std::any_of(triangles.begin(), triangles.end(),
                     [&](const Triangle3& t) { return cutter.Add(t), cutter.any(); });
}

}  // namespace flaneur
