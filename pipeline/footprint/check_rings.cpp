#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/footprint/check_parts.h"

namespace flaneur {
namespace {

constexpr double kSamePoint_m = 0.001;
constexpr double kSpikeWidth_m = 0.01;   // what an opening with this radius takes away, and
constexpr double kSpikeLength_m = 0.1;   // is longer than this, is a spike
constexpr double kRounding_m = 0.0005;   // the opening's own, along every edge
constexpr double kSpikeMiter = 20;       // corners down to 6 degrees survive the opening
constexpr double kHoleSlack_m2 = 1e-4;
constexpr int kCircleCorners = 32;

double Distance(Point2 a, Point2 b) { return std::hypot(b.x - a.x, b.y - a.y); }
double Turn(Point2 a, Point2 b, Point2 c) { return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y); }

bool Cross(Point2 a, Point2 b, Point2 c, Point2 d) {
  const double abc = Turn(a, b, c), abd = Turn(a, b, d), cda = Turn(c, d, a), cdb = Turn(c, d, b);
  return ((abc > 0) != (abd > 0)) && ((cda > 0) != (cdb > 0)) && abc != 0 && abd != 0 && cda != 0 && cdb != 0;
}

// Touching without crossing is left to the areas; sorted by x, so that large rings stay cheap.
bool FindCrossing(const Ring& ring, Point2* at) {
  const size_t n = ring.size();
  const auto low = [&](size_t i) { return std::min(ring[i].x, ring[(i + 1) % n].x); };
  const auto high = [&](size_t i) { return std::max(ring[i].x, ring[(i + 1) % n].x); };
  std::vector<size_t> order(n);
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t i, size_t j) { return low(i) < low(j); });
  for (size_t u = 0; u < n; ++u) {
    for (size_t v = u + 1; v < n && low(order[v]) <= high(order[u]); ++v) {
      const Point2 a = ring[order[u]], b = ring[(order[u] + 1) % n];
      const Point2 c = ring[order[v]], d = ring[(order[v] + 1) % n];
      if (!Cross(a, b, c, d)) continue;
      const double t = Turn(c, d, a) / (Turn(c, d, a) - Turn(c, d, b));
      *at = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
      return true;
    }
  }
  return false;
}

class ObstacleCheck {
 public:
  ObstacleCheck(CheckState* state, size_t index) : state_(*state), entry_(state->obstacles[index]), index_(index) {}

  void Run() {
    const Obstacle& o = *entry_.obstacle;
    if (o.outer.empty() && o.holes.empty() && (o.radius_m != 0 || IsCircle())) return RunCircle();
    bool sound = RunRing(o.outer, 0);
    for (size_t i = 0; i < o.holes.size(); ++i) sound = RunRing(o.holes[i], static_cast<int>(i) + 1) && sound;
    if (!sound) return;
    RunHoles();
    RunSpikes();
    entry_.rings = Union(rings_, {});
    entry_.sound = !entry_.rings.empty();
  }

 private:
  // A polygon without points comes with its ring listed as open; a circle has no rings at all.
  bool IsCircle() const {
    return index_ >= state_.options.open_rings.size() || state_.options.open_rings[index_].empty();
  }

  void Add(int code, Point2 at, double value, double limit, const std::string& detail) {
    state_.Add(code, entry_.obstacle->name, at, value, limit, detail);
  }

  bool Finite(Point2 p) {
    const double limit = state_.options.largest_coordinate_m;
    const double size = std::isnan(p.x) ? p.x : std::isnan(p.y) ? p.y : std::max(std::abs(p.x), std::abs(p.y));
    if (size <= limit) return true;
    Add(107, {}, size, limit, std::isfinite(size) ? std::to_string(size) : "not a number");
    return false;
  }

  void RunCircle() {
    const Obstacle& o = *entry_.obstacle;
    if (!Finite(o.center)) return;
    if (!(o.radius_m > 0) || !std::isfinite(o.radius_m)) return Add(109, o.center, o.radius_m, 0, Metres(o.radius_m));
    Ring ring;
    for (int i = 0; i < kCircleCorners; ++i) {
      const double angle = 2 * 3.14159265358979 * i / kCircleCorners;
      ring.push_back({o.center.x + o.radius_m * std::cos(angle), o.center.y + o.radius_m * std::sin(angle)});
    }
    entry_.rings = {ring};
    entry_.sound = true;
  }

  bool RunRing(const Ring& points, int number) {
    const std::string name = number == 0 ? "outer ring" : "hole " + std::to_string(number);
    for (const Point2& p : points)
      if (!Finite(p)) return false;
    Ring ring;
    for (const Point2& p : points)
      if (ring.empty() || Distance(ring.back(), p) >= kSamePoint_m) ring.push_back(p);
    while (ring.size() > 1 && Distance(ring.front(), ring.back()) < kSamePoint_m) ring.pop_back();
    if (ring.size() < 3) {
      Add(101, points.empty() ? Point2{} : points[0], static_cast<double>(ring.size()), 3, name);
      return false;
    }
    if (IsOpen(number)) Add(103, points.back(), Distance(points.front(), points.back()), 0, name);
    ReportNearPoints(points, name);
    if (static_cast<int>(ring.size()) > state_.options.most_points)
      Add(108, ring[0], static_cast<double>(ring.size()), state_.options.most_points,
          name + " has " + std::to_string(ring.size()));
    Point2 at;
    if (FindCrossing(ring, &at)) {
      Add(104, at, 0, 0, name);
      return false;
    }
    const double area = SignedArea(ring);
    if (std::abs(area) < state_.options.least_area_m2) {
      Add(106, ring[0], std::abs(area), state_.options.least_area_m2, name);
      return false;
    }
    if ((area > 0) != (number == 0)) Add(105, ring[0], area, 0, name);
    rings_.push_back(ring);
    return true;
  }

  bool IsOpen(int number) const {
    if (index_ >= state_.options.open_rings.size()) return false;
    const std::vector<int>& open = state_.options.open_rings[index_];
    return std::find(open.begin(), open.end(), number) != open.end();
  }

  void ReportNearPoints(const Ring& points, const std::string& name) {
    const size_t n = points.size();
    for (size_t i = 0; i < n; ++i) {
      const double d = Distance(points[i], points[(i + 1) % n]);
      if (d < kSamePoint_m) return Add(102, points[i], d, kSamePoint_m, name);
    }
  }

  void RunHoles() {
    for (size_t i = 1; i < rings_.size(); ++i) {
      const double outside = Area(Difference({rings_[i]}, {rings_[0]}));
      if (outside > kHoleSlack_m2)
        Add(201, rings_[i][0], outside, kHoleSlack_m2, "hole " + std::to_string(i));
      for (size_t j = 1; j < i; ++j) {
        const double shared = Area(Intersection({rings_[i]}, {rings_[j]}));
        if (shared > kHoleSlack_m2)
          Add(202, rings_[i][0], shared, kHoleSlack_m2, "holes " + std::to_string(j) + " and " + std::to_string(i));
      }
    }
  }

  void RunSpikes() {
    const Rings whole = Union(rings_, {});
    const Rings opened = Offset(Offset(whole, -kSpikeWidth_m, kSpikeMiter), kSpikeWidth_m + kRounding_m, kSpikeMiter);
    for (const Ring& lost : Difference(whole, opened)) {
      double length = 0;
      Point2 tip = lost[0];
      for (const Point2& p : lost) {
        for (const Point2& q : lost)
          if (Distance(p, q) > length) length = Distance(p, q), tip = p;
      }
      if (length > kSpikeLength_m) return Add(203, tip, length, kSpikeLength_m, Metres(length) + " long");
    }
    ReportFolds();
  }

  // A spike without any width: the ring turns straight back.
  void ReportFolds() {
    for (const Ring& ring : rings_) {
      const size_t n = ring.size();
      for (size_t i = 0; i < n; ++i) {
        const Point2 a = ring[(i + n - 1) % n], b = ring[i], c = ring[(i + 1) % n];
        const double length = std::min(Distance(a, b), Distance(b, c));
        const bool back = (a.x - b.x) * (c.x - b.x) + (a.y - b.y) * (c.y - b.y) > 0;
        if (length > kSpikeLength_m && back && std::abs(Turn(a, b, c)) < 1e-4 * Distance(a, b) * Distance(b, c))
          return Add(203, b, length, kSpikeLength_m, Metres(length) + " long");
      }
    }
  }

  CheckState& state_;
  CheckedObstacle& entry_;
  size_t index_;
  Rings rings_;
};

void FindBox(CheckedObstacle* entry) {
  entry->min = {1e300, 1e300}, entry->max = {-1e300, -1e300};
  for (const Ring& ring : entry->rings) {
    for (const Point2& p : ring) {
      entry->min = {std::min(entry->min.x, p.x), std::min(entry->min.y, p.y)};
      entry->max = {std::max(entry->max.x, p.x), std::max(entry->max.y, p.y)};
    }
  }
}

}  // namespace

void CheckRings(CheckState* state) {
  for (size_t i = 0; i < state->obstacles.size(); ++i) {
    ObstacleCheck(state, i).Run();
    FindBox(&state->obstacles[i]);
  }
}

}  // namespace flaneur
