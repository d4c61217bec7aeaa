#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/footprint/check_parts.h"
#include "pipeline/footprint/constants.h"

namespace flaneur {
namespace {

double Distance(Point2 a, Point2 b) { return std::hypot(b.x - a.x, b.y - a.y); }
double Turn(Point2 a, Point2 b, Point2 c) { return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y); }

bool Crosses(Point2 a, Point2 b, Point2 c, Point2 d) {
  const double abc = Turn(a, b, c), abd = Turn(a, b, d), cda = Turn(c, d, a), cdb = Turn(c, d, b);
  return ((abc > 0) != (abd > 0)) && ((cda > 0) != (cdb > 0)) && abc != 0 && abd != 0 && cda != 0 && cdb != 0;
}

// The distance of two edges that do not cross, and where on the first or second it is taken.
double EdgeDistance(Point2 a, Point2 b, Point2 c, Point2 d, Point2* at) {
  const std::pair<double, Point2> all[] = {{DistanceToSegment(a, c, d), a},
                                           {DistanceToSegment(b, c, d), b},
                                           {DistanceToSegment(c, a, b), c},
                                           {DistanceToSegment(d, a, b), d}};
  const auto* nearest =
      std::min_element(std::begin(all), std::end(all), [](const auto& p, const auto& q) { return p.first < q.first; });
  *at = nearest->second;
  return nearest->first;
}

struct Crossing {
  size_t first, second;
  Point2 at;
};  // of edges; first < second

// Where edges that are not neighbours cross or touch.
std::vector<Crossing> FindCrossings(const Ring& ring) {
  const size_t n = ring.size();
  std::vector<Crossing> found;
  const auto low = [&](size_t i) { return std::min(ring[i].x, ring[(i + 1) % n].x); };
  const auto high = [&](size_t i) { return std::max(ring[i].x, ring[(i + 1) % n].x); };
  const auto south = [&](size_t i) { return std::min(ring[i].y, ring[(i + 1) % n].y); };
  const auto north = [&](size_t i) { return std::max(ring[i].y, ring[(i + 1) % n].y); };
  std::vector<size_t> order(n);
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t i, size_t j) { return low(i) < low(j); });
  for (size_t u = 0; u < n; ++u) {
    for (size_t v = u + 1; v < n && low(order[v]) <= high(order[u]) + kTouch_m; ++v) {
      const size_t i = std::min(order[u], order[v]), j = std::max(order[u], order[v]);
      if (south(i) > north(j) + kTouch_m || south(j) > north(i) + kTouch_m) continue;
      if (j == i + 1 || (i == 0 && j == n - 1)) continue;
      const Point2 a = ring[i], b = ring[i + 1], c = ring[j], d = ring[(j + 1) % n];
      Point2 at;
      if (Crosses(a, b, c, d)) {
        const double t = Turn(c, d, a) / (Turn(c, d, a) - Turn(c, d, b));
        at = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
      } else if (EdgeDistance(a, b, c, d, &at) > kTouch_m) {
        continue;
      }
      found.push_back({i, j, at});
      if (found.size() == kMaxCrossings) return found;
    }
  }
  return found;
}

// The hull of the loop that two crossing edges close: the shorter way round.
Ring LoopOf(const Ring& ring, const Crossing& crossing) {
  const size_t n = ring.size(), inside = crossing.second - crossing.first;
  const bool shorter = inside <= n - inside;
  const size_t from = shorter ? crossing.first : crossing.second, count = (shorter ? inside : n - inside) + 2;
  Ring loop;
  for (size_t i = 0; i < count; ++i) loop.push_back(ring[(from + i) % n]);
  return ConvexHull(std::move(loop));
}

// Whether an opening or closing with this radius can matter: edges that are not neighbours come near each other, or a
// corner is sharp.
bool HasNarrowPart(const Rings& rings, double width_m, double sharp_cosine) {
  struct Edge {
    Point2 a, b;
    size_t ring, index;
  };
  std::vector<Edge> edges;
  for (size_t r = 0; r < rings.size(); ++r)
    for (size_t i = 0; i < rings[r].size(); ++i)
      edges.push_back({rings[r][i], rings[r][(i + 1) % rings[r].size()], r, i});
  if (edges.size() > kMaxNearEdges) return true;
  for (size_t u = 0; u < edges.size(); ++u) {
    const Edge& e = edges[u];
    const size_t n = rings[e.ring].size();
    const Point2 c = rings[e.ring][(e.index + 2) % n];
    const double dot = (e.a.x - e.b.x) * (c.x - e.b.x) + (e.a.y - e.b.y) * (c.y - e.b.y);
    if (dot > sharp_cosine * Distance(e.a, e.b) * Distance(c, e.b)) return true;
    for (size_t v = u + 1; v < edges.size(); ++v) {
      const Edge& f = edges[v];
      if (f.ring == e.ring && (f.index == e.index + 1 || (e.index == 0 && f.index == n - 1))) continue;
      if (std::max(e.a.x, e.b.x) + width_m < std::min(f.a.x, f.b.x) ||
          std::max(f.a.x, f.b.x) + width_m < std::min(e.a.x, e.b.x) ||
          std::max(e.a.y, e.b.y) + width_m < std::min(f.a.y, f.b.y) ||
          std::max(f.a.y, f.b.y) + width_m < std::min(e.a.y, e.b.y))
        continue;
      Point2 at;
      if (EdgeDistance(e.a, e.b, f.a, f.b, &at) < width_m) return true;
    }
  }
  return false;
}

class ObstacleCheck {
 public:
  ObstacleCheck(CheckState* state, size_t index) : state_(*state), entry_(state->obstacles[index]), index_(index) {}

  void Run() {
    const Obstacle& o = *entry_.obstacle;
    if (o.outer.empty() && o.holes.empty() && IsCircle()) return RunCircle();
    const Rings outer = RunRing(o.outer, 0);
    std::vector<Rings> holes;
    for (size_t i = 0; i < o.holes.size(); ++i) {
      const bool sound = entry_.sound;
      holes.push_back(RunRing(o.holes[i], static_cast<int>(i) + 1));
      entry_.holes_broken |= holes.back().empty() || (sound && !entry_.sound);
    }
    RunHoles(outer, holes);
    if (outer.empty()) return;
    Assemble(outer, holes);
    RunSpikes(holes);
  }

 private:
  // A polygon without points comes with its ring listed as open; a circle has no rings at all.
  bool IsCircle() const {
    return index_ >= state_.options.open_rings.size() || state_.options.open_rings[index_].empty();
  }

  void Add(int code, Point2 at, double value, double limit, const std::string& detail) {
    state_.Add(code, entry_.obstacle->name, at, value, limit, detail);
    if (code < 203 && code != 102 && code != 103 && code != 105 && code != 108) entry_.sound = false;
  }

  // NaN where it is not a number.
  static double SizeOf(Point2 p) {
    return std::isnan(p.x) || std::isnan(p.y) ? p.x + p.y : std::max(std::abs(p.x), std::abs(p.y));
  }
  bool Fits(Point2 p) const { return SizeOf(p) <= state_.options.largest_coordinate_m; }
  static std::string SizeText(double size) { return std::isfinite(size) ? Metres(size) : "not a number"; }

  void RunCircle() {
    const Obstacle& o = *entry_.obstacle;
    const double limit = state_.options.largest_coordinate_m;
    const bool fits = Fits(o.center) && !(o.radius_m > limit);
    if (!fits)
      Add(107, {}, Fits(o.center) ? o.radius_m : SizeOf(o.center), limit,
          SizeText(Fits(o.center) ? o.radius_m : SizeOf(o.center)));
    if (!(o.radius_m > 0))
      Add(109, Fits(o.center) ? o.center : Point2{}, o.radius_m, 0,
          std::isnan(o.radius_m) ? "none given" : Metres(o.radius_m));
    if (fits && o.radius_m > 0) entry_.rings = {CircleRing(o.center, o.radius_m)};
  }

  // 107. The points that are left.
  Ring FittingPoints(const Ring& points, const std::string& name, bool outer) {
    Ring fitting;
    size_t bad = 0, first = 0;
    for (size_t i = 0; i < points.size(); ++i) {
      if (Fits(points[i])) fitting.push_back(points[i]);
      else if (bad++ == 0) first = i;
    }
    if (bad == 0) return fitting;
    const Point2 place = fitting.empty() ? Point2{} : fitting[std::min(first > 0 ? first - 1 : 0, fitting.size() - 1)];
    const double size = SizeOf(points[first]);
    Add(107, place, size, state_.options.largest_coordinate_m,
        "point " + std::to_string(first) + " of " + name + " (" + SizeText(size) + ")" +
            (bad > 1 ? " and " + std::to_string(bad - 1) + " more" : ""));
    entry_.points_missing |= outer;
    return fitting;
  }

  // Without neighbours that nearly coincide. In a tiny ring only those that do coincide: its area says what is wrong.
  Ring DistinctPoints(const Ring& points, bool* tiny) const {
    Point2 min{1e300, 1e300}, max{-1e300, -1e300};
    for (const Point2& p : points) {
      min = {std::min(min.x, p.x), std::min(min.y, p.y)};
      max = {std::max(max.x, p.x), std::max(max.y, p.y)};
    }
    *tiny = max.x - min.x < 10 * state_.options.same_point_m && max.y - min.y < 10 * state_.options.same_point_m;
    const double same = *tiny ? 1e-9 : state_.options.same_point_m;
    Ring ring;
    for (const Point2& p : points)
      if (ring.empty() || Distance(ring.back(), p) >= same) ring.push_back(p);
    while (ring.size() > 1 && Distance(ring.front(), ring.back()) < same) ring.pop_back();
    return ring;
  }

  // Up to three.
  size_t CountDistinct(const Ring& ring) const {
    const double same = std::min(state_.options.same_point_m, 1e-9);
    if (ring.empty()) return 0;
    const Point2* second = nullptr;
    for (const Point2& p : ring) {
      if (Distance(p, ring[0]) <= same) continue;
      if (!second) second = &p;
      else if (Distance(p, *second) > same) return 3;
    }
    return second ? 2 : 1;
  }

  // What the ring encloses; empty where that cannot be told.
  Rings RunRing(const Ring& points, int number) {
    const std::string name = number == 0 ? "outer ring" : "hole " + std::to_string(number);
    const bool sound_before = entry_.sound;
    const Ring fitting = FittingPoints(points, name, number == 0);
    const bool complete = fitting.size() == points.size();
    bool tiny = false;
    Ring ring = DistinctPoints(fitting, &tiny);
    const size_t distinct = ring.size() < 3 ? ring.size() : CountDistinct(ring);
    if (distinct < 3) {
      if (complete) Add(101, points.empty() ? Point2{} : points[0], static_cast<double>(distinct), 3, name);
      return {};
    }
    ReportOpen(fitting, number, name, complete);
    if (!tiny) ReportNearPoints(fitting, name);
    const size_t most = static_cast<size_t>(state_.options.most_points);
    const bool huge = ring.size() > kManyPoints * most;
    if (ring.size() > most)
      Add(108, ring[0], static_cast<double>(ring.size()), static_cast<double>(most),
          name + " has " + std::to_string(ring.size()) + (huge ? "; too many to look at its shape" : ""));
    if (huge) return entry_.sound = false, Rings();
    RemoveHairlines(&ring, name);
    if (ring.size() < 3) return ReportSmall(0, fitting[0], name), Rings();
    return AreaOf(ring, number, name, sound_before && complete);
  }

  Rings AreaOf(const Ring& ring, int number, const std::string& name, bool complete) {
    const std::vector<Crossing> crossings = FindCrossings(ring);
    const double area = SignedArea(ring);
    if (crossings.empty()) {
      const bool small = std::abs(area) < state_.options.least_area_m2;
      if (small) ReportSmall(std::abs(area), ring[0], name);
      const double least = state_.options.same_point_m * state_.options.same_point_m;
      if ((area > 0) != (number == 0) && std::abs(area) > least) Add(105, ring[0], area, 0, name);
      if (small) return {};
      return {area > 0 ? ring : Ring(ring.rbegin(), ring.rend())};
    }
    if (complete) Add(104, crossings[0].at, static_cast<double>(crossings.size()), 0, name);
    for (const Crossing& crossing : crossings) entry_.doubt.push_back(LoopOf(ring, crossing));
    const bool readable =
        ring.size() <= static_cast<size_t>(state_.options.most_points) && crossings.size() < kMaxCrossings;
    if (!readable) return {ConvexHull(ring)};
    Rings filled = NonZeroArea(ring);
    const double whole = Area(filled),
                 wrong = number == 0 ? whole - area : whole + area;  // twice what runs the wrong way
    if (wrong / 2 > kMinTurnedRatio * std::max(whole - wrong / 2, 0.0)) Add(105, ring[0], area, 0, name);
    if (whole < state_.options.least_area_m2) return ReportSmall(whole, ring[0], name), Rings();
    return filled;
  }

  void ReportSmall(double area, Point2 at, const std::string& name) {
    Add(106, at, area, state_.options.least_area_m2, name + " encloses " + SquareMetres(area));
  }

  void ReportOpen(const Ring& points, int number, const std::string& name, bool complete) {
    if (!complete || index_ >= state_.options.open_rings.size()) return;
    const std::vector<int>& open = state_.options.open_rings[index_];
    if (std::find(open.begin(), open.end(), number) == open.end()) return;
    const double gap = Distance(points.front(), points.back());
    if (gap >= state_.options.same_point_m) Add(103, points.back(), gap, 0, name);
  }

  void ReportNearPoints(const Ring& points, const std::string& name) {
    const size_t n = points.size();
    size_t count = 0, worst = 0;
    double least = state_.options.same_point_m;
    for (size_t i = 0; i < n; ++i) {
      const double d = Distance(points[i], points[(i + 1) % n]);
      if (d >= state_.options.same_point_m) continue;
      ++count;
      if (d < least) least = d, worst = i;
    }
    if (count == 0) return;
    Add(102, points[worst], least, state_.options.same_point_m,
        "point " + std::to_string(worst) + " of " + name +
            (count > 1 ? ", and " + std::to_string(count - 1) + " more" : ""));
  }

  // 203: spikes without area. They are taken out, so that they don't count as crossings.
  void RemoveHairlines(Ring* ring, const std::string& name) {
    double longest = 0;
    Point2 tip;
    for (size_t i = 0; i < ring->size() && ring->size() >= 3;) {
      const size_t n = ring->size();
      const Point2 a = (*ring)[(i + n - 1) % n], b = (*ring)[i], c = (*ring)[(i + 1) % n];
      const double ab = Distance(a, b), bc = Distance(b, c);
      const bool back = (a.x - b.x) * (c.x - b.x) + (a.y - b.y) * (c.y - b.y) > 0;
      if (!back || std::abs(Turn(a, b, c)) > kHairline_rad * ab * bc) {
        ++i;
        continue;
      }
      if (std::min(ab, bc) > longest) longest = std::min(ab, bc), tip = b;
      ring->erase(ring->begin() + static_cast<std::ptrdiff_t>(i));
      const size_t left = ring->size(), next = i % left, before = (i + left - 1) % left;
      if (Distance((*ring)[before], (*ring)[next]) < state_.options.same_point_m)
        ring->erase(ring->begin() + static_cast<std::ptrdiff_t>(next));
      i = i > 2 ? i - 2 : 0;
    }
    if (longest <= state_.options.spike_length_m) return;
    if (ring->size() >= 3) ReportSpike(tip, longest, name);
  }

  void ReportSpike(Point2 at, double length, const std::string& name) {
    if (spike_reported_) return;
    spike_reported_ = true;
    Add(203, at, length, state_.options.spike_length_m, name + ", " + Metres(length) + " long");
  }

  void RunHoles(const Rings& outer, const std::vector<Rings>& holes) {
    const double limit = state_.options.least_area_m2;
    for (size_t i = 0; i < holes.size(); ++i) {
      if (holes[i].empty()) continue;
      const std::string name = "hole " + std::to_string(i + 1);
      Rings known = outer;
      known.insert(known.end(), entry_.doubt.begin(), entry_.doubt.end());
      const double outside = outer.empty() ? 0 : Area(Difference(holes[i], UnionOfAreas(known)));
      if (outside > limit)
        Add(201, holes[i][0][0], outside, limit, name + ", " + SquareMetres(outside)), entry_.holes_broken = true;
      for (size_t j = 0; j < i; ++j) {
        const double shared = holes[j].empty() ? 0 : Area(Intersection(holes[i], holes[j]));
        if (shared > limit)
          Add(202, holes[i][0][0], shared, limit, "holes " + std::to_string(j + 1) + " and " + std::to_string(i + 1)),
              entry_.holes_broken = true;
      }
    }
  }

  void Assemble(const Rings& outer, const std::vector<Rings>& holes) {
    entry_.rings = outer;
    if (entry_.sound) {
      for (const Rings& hole : holes)
        for (const Ring& ring : hole) entry_.rings.emplace_back(ring.rbegin(), ring.rend());
      return;
    }
    if (entry_.holes_broken) return;  // where its free ground is cannot be told
    Rings all;
    for (const Rings& hole : holes) all.insert(all.end(), hole.begin(), hole.end());
    entry_.rings = Difference(outer, UnionOfAreas(all));
  }

  // Parts that an opening takes away; of holes too, which are slits in the obstacle. What is left is the obstacle.
  void RunSpikes(const std::vector<Rings>& holes) {
    Rings left = entry_.rings;
    if (LosesPart(&left, "")) {
      entry_.spikes = Difference(entry_.rings, left);
      entry_.rings = std::move(left);
    }
    for (size_t i = 0; i < holes.size(); ++i) {
      Rings hole = holes[i];
      if (!hole.empty()) LosesPart(&hole, "hole " + std::to_string(i + 1));
    }
  }

  bool LosesPart(Rings* area, const std::string& name) {
    const double width = state_.options.spike_width_m, length = state_.options.spike_length_m;
    const double sharp = 2 * std::asin(1 / kSpikeMiter);
    if (!HasNarrowPart(*area, 2 * width, std::cos(sharp))) return false;
    const Rings opened = Offset(Offset(*area, -width, kSpikeMiter), width + kOpeningRounding_m, kSpikeMiter);
    for (const Ring& lost : Difference(*area, opened)) {
      const Ring hull = ConvexHull(lost);
      double longest = 0;
      for (const Point2& p : hull)
        for (const Point2& q : hull) longest = std::max(longest, Distance(p, q));
      if (longest <= length) continue;
      if (std::any_of(entry_.doubt.begin(), entry_.doubt.end(),
                      [&](const Ring& doubt) { return Area(Intersection({lost}, {doubt})) > 0; }))
        continue;  // a crossing's tips
      ReportSpike(lost[0], longest, name.empty() ? "a part" : name);
      *area = Intersection(*area, opened);
      return true;
    }
    return false;
  }

  CheckState& state_;
  CheckedObstacle& entry_;
  size_t index_;
  bool spike_reported_ = false;
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
