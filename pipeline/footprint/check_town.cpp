#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "pipeline/footprint/band.h"
#include "pipeline/footprint/check_parts.h"
#include "pipeline/footprint/extract_footprints.h"
#include "pipeline/footprint/overhead.h"
#include "pipeline/footprint/town_objects.h"

namespace flaneur {
namespace {

constexpr double kSampleStep_m = 0.2;     // along walls
constexpr double kMissingShare = 0.5;     // of a building's area uncovered: it has no obstacle
constexpr double kStrangeShare = 0.05;    // of an obstacle's area on buildings: less, and it has no building
constexpr double kOverCover_m2 = 0.01;
constexpr double kSeam_m = 0.0125;        // cracks between neighbours up to twice this are nobody's way, and welded

Rings AllAreas(const CheckState& state) {
  Rings all;
  for (const CheckedObstacle& entry : state.obstacles) {
    const Rings grown = entry.sound ? Offset(entry.rings, kSeam_m) : Rings();
    all.insert(all.end(), grown.begin(), grown.end());
  }
  return Offset(UnionOfAreas(all), -kSeam_m);
}

Rings RingsOf(const Obstacle& o) {
  Rings rings{o.outer};
  rings.insert(rings.end(), o.holes.begin(), o.holes.end());
  return rings;
}

bool BoxesMeet(const CheckedObstacle& entry, const Rings& rings) {
  Point2 min{1e300, 1e300}, max{-1e300, -1e300};
  for (const Point2& p : rings[0])
    min = {std::min(min.x, p.x), std::min(min.y, p.y)}, max = {std::max(max.x, p.x), std::max(max.y, p.y)};
  return entry.min.x <= max.x && min.x <= entry.max.x && entry.min.y <= max.y && min.y <= entry.max.y;
}

class TownCheck {
 public:
  TownCheck(const Scene& town, CheckState* state)
      : scene_(town), state_(*state), objects_(SortTown(town, state->options.scale)) {}

  Error Run() {
    FootprintOptions options;
    options.clearance_m = std::max(state_.clearance_m, 0.0);
    options.band_m = state_.footprints.band_m;
    options.scale = state_.options.scale;
    options.tolerance_m = 0;
    FootprintStats stats;
    if (Error error = ExtractFootprints(scene_, options, &truth_, &stats)) return error;
    if (Error error = RasterizeGround(objects_, {}, &raster_)) return error;
    for (const TownObject& object : objects_.obstacles) overhead_.Add(object.triangles);
    FindMissing();
    FindWalls();
    FindStrange();
    FindOverCover();
    for (const std::string& name : stats.open_shells)
      state_.Add(306, name, MiddleOf(name), 0, 0, "some walls of '" + name + "' enclose nothing");
    return Ok();
  }

 private:
  Point2 MiddleOf(const std::string& name) const {
    for (const TownObject& o : objects_.obstacles)
      if (o.name == name) return {(o.min_m.x + o.max_m.x) / 2, (o.min_m.y + o.max_m.y) / 2};
    return {};
  }

  // 304: buildings of which most is uncovered; their walls are not reported once more.
  void FindMissing() {
    std::map<std::string, std::pair<double, double>> areas;  // by source: all, and covered
    std::map<std::string, Point2> places;
    for (const Obstacle& o : truth_.obstacles) {
      if (o.outer.empty()) continue;
      const Rings rings = RingsOf(o);
      auto& [all, covered] = areas[o.source];
      all += Area(rings);
      for (const CheckedObstacle& entry : state_.obstacles)
        if (entry.sound && BoxesMeet(entry, rings)) covered += Area(Intersection(rings, entry.rings));
      places.try_emplace(o.source, o.outer[0]);
    }
    for (const auto& [source, area] : areas) {
      if (area.second >= kMissingShare * area.first) continue;
      missing_.insert(source);
      state_.Add(304, source, places[source], area.second / area.first, kMissingShare, "'" + source + "'");
    }
  }

  // 301, 302: once for each object, at the worst place.
  void FindWalls() {
    const double tolerance = state_.options.tolerance_m;
    const AreaIndex cover(AllAreas(state_), 1.0);
    const LocalGround ground(raster_);
    for (const TownObject& object : objects_.obstacles) {
      if (missing_.contains(object.name)) continue;
      if (object.kind == ObstacleKind::kTree || object.kind == ObstacleKind::kLamp) continue;
      double least = 1e300;
      Point2 at;
      for (const Segment& s : Lines(CutToBand(object.triangles, ground, state_.footprints.band_m))) {
        const double length = std::hypot(s.b.x - s.a.x, s.b.y - s.a.y);
        const int steps = std::max(1, static_cast<int>(std::ceil(length / kSampleStep_m)));
        for (int i = 0; i <= steps; ++i) {
          const double t = static_cast<double>(i) / steps;
          const Point2 p{s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)};
          const double depth = cover.Depth(p);
          if (depth < least) least = depth, at = p;
        }
      }
      if (least < -tolerance)
        state_.Add(301, object.name, at, -least, tolerance, "a wall of '" + object.name + "' stands out by " + Metres(-least));
      else if (least < state_.clearance_m - tolerance)
        state_.Add(302, object.name, at, std::max(least, 0.0), state_.clearance_m,
                   "only " + Metres(std::max(least, 0.0)) + " beside a wall of '" + object.name + "'");
    }
  }

  // The walls and clearance as they should be, circles included.
  Rings Truth() const {
    Rings all;
    for (const Obstacle& o : truth_.obstacles) {
      if (o.outer.empty()) {
        Ring ring;
        for (int i = 0; i < 32; ++i)
          ring.push_back({o.center.x + o.radius_m * std::cos(i * 0.19634954), o.center.y + o.radius_m * std::sin(i * 0.19634954)});
        all.push_back(ring);
        continue;
      }
      const Rings rings = RingsOf(o);
      all.insert(all.end(), rings.begin(), rings.end());
    }
    return UnionOfAreas(all);
  }

  void FindStrange() {
    truth_area_ = Truth();
    for (const CheckedObstacle& entry : state_.obstacles) {
      if (!entry.sound) continue;
      const double share = Area(Intersection(entry.rings, truth_area_)) / Area(entry.rings);
      if (share >= kStrangeShare) continue;
      strange_.insert(&entry);
      state_.Add(305, entry.obstacle->name, entry.rings[0][0], share, kStrangeShare, "'" + entry.obstacle->name + "'");
    }
  }

  // 303 and 307, once a piece.
  void FindOverCover() {
    const Rings allowed = Offset(truth_area_, state_.options.tolerance_m + 0.002);
    for (const CheckedObstacle& entry : state_.obstacles) {
      if (!entry.sound || strange_.contains(&entry)) continue;
      for (const Polygon& piece : ToPolygons(Difference(entry.rings, allowed))) {
        Rings rings{piece.outer};
        rings.insert(rings.end(), piece.holes.begin(), piece.holes.end());
        if (Area(rings) < kOverCover_m2) continue;
        const Rings walkable = Offset(rings, -state_.options.person_radius_m);
        const std::string& name = entry.obstacle->name;
        if (!walkable.empty() && Roofed(walkable[0][0]))
          state_.Add(307, name, walkable[0][0], Area(rings), kOverCover_m2, "'" + name + "' covers a way under a building");
        else
          state_.Add(303, name, piece.outer[0], Area(rings), kOverCover_m2,
                     "'" + name + "' takes " + Metres(Area(rings)) + "2 of free ground");
      }
    }
  }

  bool Roofed(Point2 p) const {
    const LocalGround ground(raster_);
    return overhead_.Covers(p, ground.Height(p.x, p.y) + state_.footprints.band_m[1]);
  }

  const Scene& scene_;
  CheckState& state_;
  TownObjects objects_;
  Footprints truth_;
  GroundRaster raster_;
  Overhead overhead_;
  Rings truth_area_;
  std::set<std::string> missing_;
  std::set<const CheckedObstacle*> strange_;
};

}  // namespace

Error CheckAgainstTown(const Scene& town, CheckState* state) { return TownCheck(town, state).Run(); }

}  // namespace flaneur
