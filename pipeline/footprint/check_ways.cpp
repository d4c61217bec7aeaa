#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "pipeline/footprint/check_parts.h"
#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/ground_outline.h"
#include "pipeline/footprint/rasterize_ground.h"
#include "pipeline/footprint/ways_parts.h"
#include "runtime/base/array.h"
#include "runtime/base/jobs.h"

namespace flaneur {
namespace {

// A stretch of ground that hangs together, for the centre of a person.
struct Region {
  Polygon shape;
  Point2 min, max;
  double area_m2 = 0;
};

Rings RingsOf(const Polygon& polygon) {
  Rings rings{polygon.outer};
  rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  return rings;
}

Region RegionOf(Polygon polygon) {
  Region region{std::move(polygon), {1e300, 1e300}, {-1e300, -1e300}, 0};
  for (const Point2& p : region.shape.outer) {
    region.min = {std::min(region.min.x, p.x), std::min(region.min.y, p.y)};
    region.max = {std::max(region.max.x, p.x), std::max(region.max.y, p.y)};
  }
  region.area_m2 = Area(RingsOf(region.shape));
  return region;
}

bool InBox(const Region& region, Point2 p) {
  return p.x >= region.min.x && p.x <= region.max.x && p.y >= region.min.y && p.y <= region.max.y;
}

std::vector<Region> RegionsOf(const Rings& area) {
  std::vector<Region> regions;
  for (Polygon& polygon : ToPolygons(area)) regions.push_back(RegionOf(std::move(polygon)));
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

// From p, or beyond.
bool IsFarther(const CheckedObstacle& entry, Point2 p, double distance) {
  const double dx = std::max({entry.min.x - p.x, 0.0, p.x - entry.max.x}),
               dy = std::max({entry.min.y - p.y, 0.0, p.y - entry.max.y});
  return dx * dx + dy * dy >= distance * distance;
}

// Obstacles that may close ground in together: their boxes come within `reach` of each other.
std::vector<std::vector<const CheckedObstacle*>> Clusters(const std::vector<CheckedObstacle>& obstacles, double reach) {
  std::vector<const CheckedObstacle*> sorted;
  for (const CheckedObstacle& entry : obstacles)
    if (!entry.rings.empty()) sorted.push_back(&entry);
  std::sort(sorted.begin(), sorted.end(), [](const auto* a, const auto* b) { return a->min.x < b->min.x; });
  std::vector<size_t> root(sorted.size());
  std::iota(root.begin(), root.end(), size_t{0});
  const auto find = [&](size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (size_t i = 0; i < sorted.size(); ++i)
    for (size_t j = i + 1; j < sorted.size() && sorted[j]->min.x <= sorted[i]->max.x + reach; ++j)
      if (sorted[j]->min.y <= sorted[i]->max.y + reach && sorted[i]->min.y <= sorted[j]->max.y + reach)
        root[find(j)] = find(i);
  std::map<size_t, std::vector<const CheckedObstacle*>> by_root;
  for (size_t i = 0; i < sorted.size(); ++i) by_root[find(i)].push_back(sorted[i]);
  std::vector<std::vector<const CheckedObstacle*>> clusters;
  for (auto& [first, members] : by_root) clusters.push_back(std::move(members));
  return clusters;
}

class WaysCheck {
 public:
  explicit WaysCheck(CheckState* state) : state_(*state), broken_(*state), placed_(state->obstacles) {}

  Error Run(const PreparedTown* town) {
    gates_ = state_.options.gates;
    if (town) {
      const std::vector<Gate> more = GatesOf(*town->scene, state_.options.scale);
      gates_.insert(gates_.end(), more.begin(), more.end());
    }
    const bool whole = town && !town->objects.ground.empty();
    if (whole) LayOutTown(*town);
    else LayOutObstacles(town ? OutlineOf(town->ground) : Rings{});
    if (ground_.empty()) return Ok();
    // Doors and exits stand in regions; without any, the network needs none.
    std::vector<Finding> findings;
    CheckState beside{state_.footprints, state_.options, state_.clearance_m, {}, &findings};
    Jobs jobs(1);
    const auto check_network = [&] {
      CheckNetworkOfWays(&beside);
      return true;
    };
    Job network;
    const auto start_network = [&] { network = StartJob(&jobs, check_network); };
    if (gates_.empty()) start_network();
    if (!whole) LayOutRegions();
    CheckGates();
    if (!gates_.empty()) start_network();
    CheckRegions();
    network.Wait();
    // What is shut in where nobody says where people come and go is only likely to be wrong.
    if (gates_.empty())
      for (Finding& finding : findings) finding.severity = Severity::kWarning;
    state_.findings->insert(state_.findings->end(), findings.begin(), findings.end());
    return Ok();
  }

 private:
  double Thickened() const { return state_.options.person_radius_m - kWaySlack_m; }
  double Welded() const { return state_.options.tolerance_m / 2; }  // cracks are nobody's way

  void LayOutTown(const PreparedTown& town) {
    ground_ = OutlineOf(town.ground);
    Rings all;
    for (const CheckedObstacle& entry : state_.obstacles) all.insert(all.end(), entry.rings.begin(), entry.rings.end());
    regions_ = RegionsOf(Difference(ground_, OffsetRound(all, Thickened())));
    open_ = Difference(ground_, Offset(all, Welded()));
    reach_ = RegionsOf(open_);
  }

  // Free ground all round, `square` where the town has that: each cluster of obstacles is looked at by itself, for
  // large plans take long as a whole.
  void LayOutObstacles(const Rings& square) {
    clusters_ = Clusters(state_.obstacles, 2 * state_.options.person_radius_m + 0.1);
    Point2 min{1e300, 1e300}, max{-1e300, -1e300};
    double covered = 0;
    for (const auto& cluster : clusters_) {
      for (const CheckedObstacle* entry : cluster) {
        min = {std::min(min.x, entry->min.x), std::min(min.y, entry->min.y)};
        max = {std::max(max.x, entry->max.x), std::max(max.y, entry->max.y)};
      }
      const Rings welded = Simplify(Offset(RingsOfAll(cluster), Welded()), Welded());
      AddEnclosed(welded, &reach_);
      for (const Ring& ring : welded) {
        covered += SignedArea(ring);
        if (!IsYard(ring)) open_.emplace_back(ring.rbegin(), ring.rend());
      }
    }
    if (open_.empty()) return;
    for (const Gate& gate : gates_) {
      min = {std::min(min.x, gate.at_m.x), std::min(min.y, gate.at_m.y)};
      max = {std::max(max.x, gate.at_m.x), std::max(max.y, gate.at_m.y)};
    }
    min = {min.x - kFreeMargin_m, min.y - kFreeMargin_m}, max = {max.x + kFreeMargin_m, max.y + kFreeMargin_m};
    for (const Ring& ring : square) {
      for (const Point2& p : ring) {
        min = {std::min(min.x, p.x), std::min(min.y, p.y)};
        max = {std::max(max.x, p.x), std::max(max.y, p.y)};
      }
    }
    ground_ = Box(min, max);
    open_.insert(open_.begin(), ground_[0]);
    outside_m2_ = std::abs(Area(ground_)) - covered;
  }

  void LayOutRegions() {
    for (const auto& cluster : clusters_) AddEnclosed(OffsetRound(RingsOfAll(cluster), Thickened()), &regions_);
  }

  static Rings RingsOfAll(const std::vector<const CheckedObstacle*>& cluster) {
    Rings all;
    for (const CheckedObstacle* entry : cluster) all.insert(all.end(), entry->rings.begin(), entry->rings.end());
    return all;
  }

  // Closed all round, with neither a door nor anything else in it: no part of the network of ways.
  bool IsYard(const Ring& ring) const {
    if (SignedArea(ring) >= 0) return false;
    const BoundingBox box = BoundingBoxOf({ring});
    const auto inside = [&](Point2 p) {
      return p.x >= box.min.x && p.x <= box.max.x && p.y >= box.min.y && p.y <= box.max.y;
    };
    return std::none_of(gates_.begin(), gates_.end(), [&](const Gate& gate) { return inside(gate.at_m); }) && [&] {
      const std::vector<size_t> near = placed_.grid.Near(box);
      return std::none_of(near.begin(), near.end(),
                          [&](size_t i) { return inside(state_.obstacles[i].min) && inside(state_.obstacles[i].max); });
    }();
  }

  // Where nothing says how people leave, they leave over the edge.
  void CheckNetworkOfWays(CheckState* beside) const {
    const bool any_exit = std::any_of(gates_.begin(), gates_.end(), [](const Gate& gate) { return gate.is_exit; });
    const auto is_open = [&](Point2 a, Point2 b) {
      return !any_exit && DistanceToBoundary(ground_, {(a.x + b.x) / 2, (a.y + b.y) / 2}) < 0.01;
    };
    CheckNetwork(open_, is_open, usable_, broken_, placed_, beside);
  }

  static Rings Box(Point2 min, Point2 max) { return {{min, {max.x, min.y}, max, {min.x, max.y}}}; }

  // The holes of an area are regions, and what stands in them are theirs.
  static void AddEnclosed(const Rings& area, std::vector<Region>* regions) {
    const size_t first = regions->size();
    for (const Ring& ring : area)
      if (SignedArea(ring) < 0) regions->push_back(RegionOf({Ring(ring.rbegin(), ring.rend()), {}}));
    for (const Ring& ring : area) {
      if (SignedArea(ring) < 0) continue;
      Region* around = nullptr;
      for (size_t i = first; i < regions->size(); ++i) {
        Region& region = (*regions)[i];
        const bool smaller = !around || region.area_m2 < around->area_m2;
        if (smaller && InBox(region, ring[0]) && Contains(region.shape.outer, ring[0])) around = &region;
      }
      if (around) around->shape.holes.emplace_back(ring.rbegin(), ring.rend());
    }
    for (size_t i = first; i < regions->size(); ++i) (*regions)[i].area_m2 = Area(RingsOf((*regions)[i].shape));
  }

  // kOutside: all round; -1: nowhere.
  static constexpr int kOutside = 1'000'000'000;
  int RegionAt(Point2 p) const {
    const double r = state_.options.person_radius_m + state_.options.tolerance_m;
    const int region = RegionNear(regions_, p, r);
    return region < 0 && outside_m2_ > 0 && !InClosed(p) ? kOutside : region;
  }
  bool InClosed(Point2 p) const { return RegionNear(reach_, p, 1e-3) >= 0; }

  // People step out of a door: a door may stand in the wall's clearance, a step ahead of it must be free.
  Point2 Outside(const Gate& gate) const {
    const double step =
        std::hypot(gate.ahead.x, gate.ahead.y) > 0 ? state_.options.person_radius_m + state_.clearance_m + 0.05 : 0;
    return {gate.at_m.x + step * gate.ahead.x, gate.at_m.y + step * gate.ahead.y};
  }

  void CheckGates() {
    const double r = state_.options.person_radius_m;
    std::vector<int> regions;
    for (const Gate& gate : gates_) {
      const Point2 p = Outside(gate);
      bool inside = false;
      const CheckedObstacle* nearest = nullptr;
      const double gap = NearestObstacle(placed_, p, &nearest, &inside);
      regions.push_back(-1);
      if (inside) {
        state_.Add(gate.is_exit ? 602 : 601, gate.name, p, gap, 0, "'" + gate.name + "'");
        continue;
      }
      if (gap < r - state_.options.tolerance_m)
        state_.Add(603, gate.name, p, gap, r, Metres(gap) + " from '" + gate.name + "' to the nearest obstacle");
      regions.back() = RegionAt(p);
      if (regions.back() >= 0) usable_.push_back({gate.name, p, {}, gate.is_exit});
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

  // 501. Ground that even a point cannot get to is a courtyard, unless it is a large part of the town or has a door; a
  // nook is no more.
  void CheckRegions() {
    const auto largest = std::max_element(regions_.begin(), regions_.end(),
                                          [](const Region& a, const Region& b) { return a.area_m2 < b.area_m2; });
    if (largest == regions_.end()) return;
    const bool outside = outside_m2_ > 0;
    const int main = outside ? kOutside : static_cast<int>(largest - regions_.begin());
    const int main_reach = outside ? -1 : RegionNear(reach_, largest->shape.outer[0], 1e-3);
    const double main_m2 = outside ? outside_m2_ : largest->area_m2;
    for (int i = 0; i < Count(regions_); ++i) {
      const Region& region = At(regions_, i);
      if (i == main || Has(cut_off_, i)) continue;  // the latter is said by 604
      const double area = Area(Offset(RingsOf(region.shape), state_.options.person_radius_m));
      if (area < state_.options.least_ground_m2) continue;
      const Ring& outline = region.shape.outer;
      if (std::any_of(outline.begin(), outline.end(),
                      [&](Point2 p) { return broken_.Near(p, 2 * state_.options.person_radius_m); }))
        continue;
      const bool closed = RegionNear(reach_, region.shape.outer[0], 1e-3) != main_reach;
      const Point2 at = PlaceIn(region);
      state_.Add(501, NearestName(placed_, at), at, area, state_.options.least_ground_m2,
                 SquareMetres(area) + (closed ? ", closed all round" : ", cut off by narrow gaps"));
      const bool large = region.area_m2 > kMinLargeShare * main_m2;
      if ((closed || area < kMaxNook_m2) && !large && !Has(has_gate_, i))
        state_.findings->back().severity = Severity::kWarning;
    }
  }

  static bool Has(const std::vector<int>& list, int i) { return std::find(list.begin(), list.end(), i) != list.end(); }

  CheckState& state_;
  BrokenPlaces broken_;
  Placed placed_;
  std::vector<Gate> gates_, usable_;                           // the latter a step ahead, on free ground
  std::vector<std::vector<const CheckedObstacle*>> clusters_;  // of obstacles, without a town
  Rings ground_, open_;                                        // all, and all without the obstacles
  double outside_m2_ = 0;                                      // of the free ground all round, where there is no town
  std::vector<Region> regions_, reach_;
  std::vector<int> has_gate_, cut_off_;  // regions
};

}  // namespace

BrokenPlaces::BrokenPlaces(const CheckState& state) {
  constexpr double kLost_m = 30, kPointsLost_m = 5, kCrossed_m = 1;  // how far an outline may have gone
  for (const CheckedObstacle& entry : state.obstacles) {
    if (entry.sound) continue;
    const double grow = entry.rings.empty() ? kLost_m : entry.points_missing ? kPointsLost_m : kCrossed_m;
    Box box{{1e300, 1e300}, {-1e300, -1e300}};
    for (const Point2& p : entry.obstacle->outer) {
      if (!(std::max(std::abs(p.x), std::abs(p.y)) <= state.options.largest_coordinate_m)) continue;
      box.min = {std::min(box.min.x, p.x - grow), std::min(box.min.y, p.y - grow)};
      box.max = {std::max(box.max.x, p.x + grow), std::max(box.max.y, p.y + grow)};
    }
    boxes_.push_back(box);
  }
}

bool BrokenPlaces::Near(Point2 p, double reach) const {
  return std::any_of(boxes_.begin(), boxes_.end(), [&](const Box& b) {
    return p.x > b.min.x - reach && p.x < b.max.x + reach && p.y > b.min.y - reach && p.y < b.max.y + reach;
  });
}

double NearestObstacle(const Placed& placed, Point2 p, const CheckedObstacle** nearest, bool* inside) {
  double least = 1e100;
  const auto visit = [&](size_t i) {
    const CheckedObstacle& entry = placed.obstacles[i];
    if (IsFarther(entry, p, least)) return;
    const double d = DistanceToBoundary(entry.rings, p);
    if (d < least || (d == least && &entry < *nearest)) least = d, *nearest = &entry;
    if (inside) *inside |= Contains(entry.rings, p);
  };
  placed.grid.Outwards(p, visit, [&] { return least; });
  return least;
}

std::string NearestName(const Placed& placed, Point2 p) {
  const CheckedObstacle* nearest = nullptr;
  NearestObstacle(placed, p, &nearest, nullptr);
  return nearest ? nearest->obstacle->name : "";
}

Error CheckWays(const PreparedTown* town, CheckState* state) { return WaysCheck(state).Run(town); }

}  // namespace flaneur
