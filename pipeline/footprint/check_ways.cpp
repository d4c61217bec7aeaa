#include <algorithm>
#include <cmath>
#include <cstdio>

#include "pipeline/footprint/check_parts.h"
#include "pipeline/footprint/ground_outline.h"
#include "pipeline/footprint/rasterize_ground.h"
#include "pipeline/footprint/ways_parts.h"

namespace flaneur {
namespace {

constexpr double kMargin_m = 3;          // round the obstacles, where there is no town
constexpr double kLargeShare = 0.1;      // of all free ground: more, and it is no courtyard
constexpr double kSlack_m = 0.0005;      // a way exactly as wide as a person counts as open

// A stretch of ground that hangs together, for the centre of a person.
struct Region { Polygon shape; Point2 min, max; double area_m2 = 0; };

Rings RingsOf(const Polygon& polygon) {
  Rings rings{polygon.outer};
  rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  return rings;
}

std::vector<Region> RegionsOf(const Rings& area) {
  std::vector<Region> regions;
  for (Polygon& polygon : ToPolygons(area)) {
    Region region{std::move(polygon), {1e300, 1e300}, {-1e300, -1e300}, 0};
    for (const Point2& p : region.shape.outer) {
      region.min = {std::min(region.min.x, p.x), std::min(region.min.y, p.y)};
      region.max = {std::max(region.max.x, p.x), std::max(region.max.y, p.y)};
    }
    region.area_m2 = Area(RingsOf(region.shape));
    regions.push_back(std::move(region));
  }
  return regions;
}

// The region round a place, within `reach` of it; -1: none.
int RegionNear(const std::vector<Region>& regions, Point2 p, double reach) {
  int best = -1;
  double nearest = reach;
  for (size_t i = 0; i < regions.size(); ++i) {
    const Region& r = regions[i];
    if (p.x < r.min.x - reach || p.x > r.max.x + reach || p.y < r.min.y - reach || p.y > r.max.y + reach) continue;
    const Rings rings = RingsOf(r.shape);
    if (Contains(rings, p)) return static_cast<int>(i);
    const double d = DistanceToBoundary(rings, p);
    if (d < nearest) nearest = d, best = static_cast<int>(i);
  }
  return best;
}

// A point inside, away from the edge where that can be had: the middle of the widest cut through the middle.
Point2 PlaceIn(const Region& region) {
  const double y = (region.min.y + region.max.y) / 2 + 1e-7;
  std::vector<double> cuts;
  for (const Ring& ring : RingsOf(region.shape))
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
      if ((ring[i].y > y) != (ring[j].y > y))
        cuts.push_back(ring[i].x + (ring[j].x - ring[i].x) * (y - ring[i].y) / (ring[j].y - ring[i].y));
  std::sort(cuts.begin(), cuts.end());
  Point2 best = region.shape.outer[0];
  double widest = 0;
  for (size_t i = 0; i + 1 < cuts.size(); i += 2)
    if (cuts[i + 1] - cuts[i] > widest) widest = cuts[i + 1] - cuts[i], best = {(cuts[i] + cuts[i + 1]) / 2, y};
  return best;
}

class WaysCheck {
 public:
  explicit WaysCheck(CheckState* state) : state_(*state) {}

  Error Run(const Scene* town) {
    gates_ = state_.options.gates;
    if (town) {
      const std::vector<Gate> more = GatesOf(*town, state_.options.scale);
      gates_.insert(gates_.end(), more.begin(), more.end());
    }
    Rings all;
    Point2 min{1e300, 1e300}, max{-1e300, -1e300};
    for (const CheckedObstacle& entry : state_.obstacles) {
      all.insert(all.end(), entry.rings.begin(), entry.rings.end());
      if (entry.rings.empty()) continue;
      min = {std::min(min.x, entry.min.x), std::min(min.y, entry.min.y)};
      max = {std::max(max.x, entry.max.x), std::max(max.y, entry.max.y)};
    }
    if (!town && all.empty()) return Ok();
    area_ = UnionOfAreas(all);
    if (town) {
      GroundRasterOptions options;
      options.scale = state_.options.scale;
      GroundRaster raster;
      if (Error error = RasterizeGround(*town, options, &raster)) return error;
      ground_ = OutlineOf(raster);
    } else {
      min = {min.x - kMargin_m, min.y - kMargin_m}, max = {max.x + kMargin_m, max.y + kMargin_m};
      ground_ = {{min, {max.x, min.y}, max, {min.x, max.y}}};
    }
    regions_ = RegionsOf(Difference(ground_, OffsetRound(area_, state_.options.person_radius_m - kSlack_m)));
    const Rings open = Difference(ground_, Offset(area_, state_.options.tolerance_m / 2));
    reach_ = RegionsOf(open);
    CheckGates();
    CheckRegions();
    // Where nothing says how people leave, they leave over the edge.
    const bool any_exit = std::any_of(gates_.begin(), gates_.end(), [](const Gate& gate) { return gate.is_exit; });
    const auto is_open = [&](Point2 a, Point2 b) {
      return !any_exit && DistanceToBoundary(ground_, {(a.x + b.x) / 2, (a.y + b.y) / 2}) < 0.01;
    };
    std::vector<Gate> outside = gates_;
    for (Gate& gate : outside) gate.at_m = Outside(gate);
    CheckNetwork(open, is_open, outside, &state_);
    return Ok();
  }

 private:
  // People step out of a door: a door may stand in the wall's clearance, a step ahead of it must be free.
  Point2 Outside(const Gate& gate) const {
    const double step = std::hypot(gate.ahead.x, gate.ahead.y) > 0 ? state_.options.person_radius_m + state_.clearance_m + 0.05 : 0;
    return {gate.at_m.x + step * gate.ahead.x, gate.at_m.y + step * gate.ahead.y};
  }

  void CheckGates() {
    const double r = state_.options.person_radius_m;
    std::vector<int> regions;
    for (const Gate& gate : gates_) {
      const Point2 p = Outside(gate);
      const double gap = DistanceToBoundary(area_, p);
      regions.push_back(-1);
      if (Contains(area_, p)) {
        state_.Add(gate.is_exit ? 602 : 601, gate.name, p, gap, 0, "'" + gate.name + "'");
        continue;
      }
      if (gap < r - state_.options.tolerance_m)
        state_.Add(603, gate.name, p, gap, r, Metres(gap) + " from '" + gate.name + "' to the nearest obstacle");
      regions.back() = RegionNear(regions_, p, r + state_.options.tolerance_m);
      if (regions.back() < 0 && gap >= r)
        state_.Add(604, gate.name, p, 0, 0, "'" + gate.name + "' stands on no ground");
    }
    bool any_exit = false;
    for (size_t i = 0; i < gates_.size(); ++i) any_exit |= gates_[i].is_exit && regions[i] >= 0;
    for (size_t i = 0; i < gates_.size(); ++i) {
      if (regions[i] < 0) continue;
      has_gate_.push_back(regions[i]);
      if (gates_[i].is_exit || !any_exit || ReachesExit(regions[i], regions)) continue;
      cut_off_.push_back(regions[i]);
      state_.Add(604, gates_[i].name, gates_[i].at_m, 0, 0, "no exit can be reached from '" + gates_[i].name + "'");
    }
  }

  bool ReachesExit(int region, const std::vector<int>& regions) const {
    for (size_t i = 0; i < gates_.size(); ++i)
      if (gates_[i].is_exit && regions[i] == region) return true;
    return false;
  }

  // 501. Ground that even a point cannot get to is a courtyard, unless it is a large part of the town or has a door.
  void CheckRegions() {
    if (regions_.empty()) return;
    const auto largest = std::max_element(regions_.begin(), regions_.end(), [](const Region& a, const Region& b) { return a.area_m2 < b.area_m2; });
    const int main = static_cast<int>(largest - regions_.begin());
    const int main_reach = RegionNear(reach_, largest->shape.outer[0], 1e-3);
    for (int i = 0; i < static_cast<int>(regions_.size()); ++i) {
      const Region& region = regions_[static_cast<size_t>(i)];
      if (i == main || Has(cut_off_, i)) continue;  // the latter is said by 604
      const double area = Area(OffsetRound(RingsOf(region.shape), state_.options.person_radius_m));
      if (area < state_.options.least_ground_m2) continue;
      const bool closed = RegionNear(reach_, region.shape.outer[0], 1e-3) != main_reach;
      const Point2 at = PlaceIn(region);
      state_.Add(501, NearestObstacle(state_, at), at, area, state_.options.least_ground_m2,
                 SquareMetres(area) + (closed ? ", closed all round" : ", cut off by narrow gaps"));
      const bool large = region.area_m2 > kLargeShare * largest->area_m2;
      if (closed && !large && !Has(has_gate_, i)) state_.findings->back().severity = Severity::kWarning;
    }
  }

  static bool Has(const std::vector<int>& list, int i) { return std::find(list.begin(), list.end(), i) != list.end(); }

  CheckState& state_;
  std::vector<Gate> gates_;
  Rings area_, ground_;
  std::vector<Region> regions_, reach_;
  std::vector<int> has_gate_, cut_off_;  // regions
};

double DistanceToBox(const CheckedObstacle& entry, Point2 p) {
  return std::hypot(std::max({entry.min.x - p.x, 0.0, p.x - entry.max.x}), std::max({entry.min.y - p.y, 0.0, p.y - entry.max.y}));
}

}  // namespace

std::string NearestObstacle(const CheckState& state, Point2 p) {
  const CheckedObstacle* nearest = nullptr;
  double least = 1e300;
  for (const CheckedObstacle& entry : state.obstacles) {
    if (entry.rings.empty() || DistanceToBox(entry, p) >= least) continue;
    const double d = DistanceToBoundary(entry.rings, p);
    if (d < least) least = d, nearest = &entry;
  }
  return nearest ? nearest->obstacle->name : "";
}

Error CheckWays(const Scene* town, CheckState* state) { return WaysCheck(state).Run(town); }

}  // namespace flaneur
