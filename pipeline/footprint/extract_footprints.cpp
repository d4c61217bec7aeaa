#include "pipeline/footprint/extract_footprints.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "pipeline/footprint/band.h"
#include "pipeline/footprint/base_ground.h"
#include "pipeline/footprint/enclosed_regions.h"
#include "pipeline/footprint/for_each.h"
#include "pipeline/footprint/one_mouth.h"
#include "pipeline/footprint/overhead.h"
#include "pipeline/footprint/polygon_sets.h"
#include "pipeline/footprint/rasterize_ground.h"
#include "pipeline/footprint/repair_shell.h"
#include "pipeline/footprint/segment_grid.h"
#include "pipeline/footprint/separate_obstacles.h"
#include "pipeline/footprint/shape.h"
#include "pipeline/footprint/town_objects.h"

namespace flaneur {
namespace {

constexpr double kLargestObject_m = 100'000;
constexpr double kNarrowestHouse_m = 0.5, kWidestHouse_m = 500;  // of most of a town
constexpr double kRoofedShare = 0.5;       // of a region's area must lie under something
constexpr double kSliver_m = 0.022;        // strips narrower than this that neighbours leave over are dropped
constexpr double kSmallestGap_m2 = 0.01;   // of a block that no single house accounts for
constexpr double kOpenShell_m = 1.0;       // of wall without anything solid beside it, in a building
constexpr double kCrumb_m = 0.02;          // of lines without area that lead nowhere
constexpr double kNoWay_m = 0.5;           // nobody passes a gap in a building narrower than this
constexpr double kSlit_m = 0.4;            // narrower yards are none
constexpr double kOnOutline_m = 0.002;     // lines this near to something solid are its outline
constexpr size_t kSamples = 16;          // of a region, to see whether it is roofed
constexpr double kThinWall_m = 0.001;      // half the thickness of a wall without any, before the clearance

struct Site {
  const FootprintOptions& options;
  const LocalGround* ground;  // the town's; null where it has none
};

// What an object stands on: one ground, or where it stands on terraces several, the lowest first.
class Stand {
 public:
  Stand(const Site& site, const TownObject& object) : town_(site.ground) {
    if (!town_) own_ = GroundsUnder(object);
  }
  size_t count() const { return town_ ? 1 : own_.size(); }
  const LocalGround& ground(size_t i) const { return town_ ? *town_ : own_[i]; }

 private:
  const LocalGround* town_;
  std::vector<LocalGround> own_;
};

// Whether a region is solid: too small for a yard, or most of it under something.
class Roofs {
 public:
  Roofs(const Site& site, const LocalGround& ground, const Overhead& overhead)
      : site_(site), ground_(ground), overhead_(overhead) {}

  bool operator()(double area_m2, const std::vector<RegionSample>& samples) const {
    if (area_m2 < site_.options.open_yard_m2) return true;
    double roofed = 0, all = 0;
    for (const auto& [p, weight] : samples) {
      all += weight;
      if (overhead_.Covers(p, ground_.Height(p.x, p.y) + site_.options.band_m[0])) roofed += weight;
    }
    return roofed > kRoofedShare * all;
  }

  bool operator()(const Rings& region) const {
    const double area_m2 = Area(region);
    return (*this)(area_m2, area_m2 < site_.options.open_yard_m2 ? std::vector<RegionSample>() : Samples(region));
  }

 private:
  // Points of a lattice, finer until enough of them are inside.
  static std::vector<RegionSample> Samples(const Rings& region) {
    Point2 min = region[0][0], max = min;
    for (const Point2& p : region[0]) {
      min = {std::min(min.x, p.x), std::min(min.y, p.y)};
      max = {std::max(max.x, p.x), std::max(max.y, p.y)};
    }
    std::vector<RegionSample> samples;
    for (int n = 8; samples.size() < kSamples && n <= 64; n *= 2) {
      samples.clear();
      for (int i = 0; i < n; ++i) {
        for (int k = 0; k < n; ++k) {
          const Point2 p{min.x + (i + 0.5) / n * (max.x - min.x), min.y + (k + 0.5) / n * (max.y - min.y)};
          if (Contains(region, p)) samples.emplace_back(p, 1.0);
        }
      }
    }
    return samples;
  }

  const Site& site_;
  const LocalGround& ground_;
  const Overhead& overhead_;
};

bool InBlocks(ObstacleKind kind) { return kind == ObstacleKind::kBuilding || kind == ObstacleKind::kWall; }

// Without the crumbs that stick out of an outline by a hair: connected pieces shorter than kCrumb_m together.
std::vector<Segment> WithoutCrumbs(const std::vector<Segment>& loose) {
  std::map<std::pair<double, double>, size_t> ends;
  std::vector<size_t> parent;
  const auto root = [&](size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const auto point = [&](Point2 p) {
    const auto [entry, is_new] = ends.try_emplace({p.x, p.y}, parent.size());
    if (is_new) parent.push_back(parent.size());
    return entry->second;
  };
  std::vector<size_t> start;
  for (const Segment& s : loose) {
    start.push_back(point(s.a));
    const size_t a = root(start.back()), b = root(point(s.b));
    parent[std::max(a, b)] = std::min(a, b);
  }
  std::vector<double> length(parent.size(), 0);
  for (size_t i = 0; i < loose.size(); ++i) length[root(start[i])] += Length(loose[i]);
  std::vector<Segment> out;
  for (size_t i = 0; i < loose.size(); ++i)
    if (length[root(start[i])] >= kCrumb_m) out.push_back(loose[i]);
  return out;
}

void SetLoose(const std::vector<Segment>& lines, Shape* shape) {
  shape->loose.clear();
  shape->open_m = 0;
  if (lines.empty()) return;
  const std::vector<Segment> loose = Outside(lines, Offset(shape->solid, kOnOutline_m));
  if (loose.empty()) return;
  const std::vector<Segment> apart = Outside(loose, Offset(shape->solid, kCrumb_m));  // not covered with what is solid
  shape->loose = WithoutCrumbs(loose);
  shape->loose.insert(shape->loose.end(), apart.begin(), apart.end());
  for (const Segment& s : apart) shape->open_m += Length(s);
}

// How many lines end at each point.
std::map<std::pair<double, double>, int> Ends(const std::vector<Segment>& lines) {
  std::map<std::pair<double, double>, int> ends;
  for (const Segment& s : lines)
    for (const Point2 p : {s.a, s.b}) ++ends[{p.x, p.y}];
  return ends;
}

// Drops crumbs that lead nowhere; whether all other lines lead on at both ends. If not, the lines stay as they are.
bool AllMeet(std::vector<Segment>* lines) {
  std::vector<Segment> kept = *lines;
  for (bool dropped = true; dropped;) {
    const auto ends = Ends(kept);
    bool dangling = false;
    dropped = std::erase_if(kept, [&](const Segment& s) {
      if (ends.at({s.a.x, s.a.y}) > 1 && ends.at({s.b.x, s.b.y}) > 1) return false;
      dangling |= Length(s) >= kCrumb_m;
      return Length(s) < kCrumb_m;
    }) > 0;
    if (dangling) return false;
  }
  *lines = std::move(kept);
  return true;
}

// Adds what the lines and what is solid already enclose under a roof, together with each other. Lines that all meet are
// taken exactly; else they are joined where they miss each other by up to reach_m.
void Close(std::vector<Segment> lines, double reach_m, const Roofs& is_solid, Shape* shape) {
  if (shape->solid.empty()) lines = CutWhereTheyMeet(std::move(lines));
  if (shape->solid.empty() && AllMeet(&lines)) {
    EnclosedRegions enclosed = EncloseRegions(lines, is_solid);
    shape->solid = std::move(enclosed.solid);
    lines = std::move(enclosed.loose);
  } else if (reach_m > 0) {
    Rings regions = shape->solid;
    for (const Rings& region : Enclosed(lines, shape->solid, reach_m / 2))
      if (!region.empty() && is_solid(region)) regions.insert(regions.end(), region.begin(), region.end());
    shape->solid = UnionOfAreas(regions);
  }
  SetLoose(lines, shape);
}

BandParts PartsInBand(const Site& site, const Stand& stand, const std::vector<Triangle3>& triangles) {
  BandParts parts = CutToBand(triangles, stand.ground(0), site.options.band_m);
  for (size_t i = 1; i < stand.count(); ++i) {
    const BandParts more = CutToBand(triangles, stand.ground(i), site.options.band_m);
    parts.walls.insert(parts.walls.end(), more.walls.begin(), more.walls.end());
    parts.areas = Union(parts.areas, more.areas);
  }
  return parts;
}

// Closes what is missing from a building's shell; whether that is something in the band.
bool Repair(const Site& site, const Stand& stand, const TownObject& object, std::vector<Triangle3>* triangles) {
  if (object.kind != ObstacleKind::kBuilding) return false;
  std::vector<Triangle3> shell = object.triangles;
  shell.insert(shell.end(), object.foundation.begin(), object.foundation.end());
  const std::vector<Triangle3> missing = MissingTriangles(shell);
  if (missing.empty()) return false;
  triangles->insert(triangles->end(), missing.begin(), missing.end());
  const BandParts parts = PartsInBand(site, stand, missing);
  return !parts.walls.empty() || !parts.areas.empty();
}

double GroundInTheMiddle(const Stand& stand, const TownObject& object) {
  return stand.ground(0).Height((object.min_m.x + object.max_m.x) / 2, (object.min_m.y + object.max_m.y) / 2);
}

Shape ShapeOf(const Site& site, const TownObject& object) {
  const Stand stand(site, object);
  Shape shape;
  shape.ground_z_m = GroundInTheMiddle(stand, object);
  std::vector<Triangle3> triangles = object.triangles;
  shape.guessed = Repair(site, stand, object, &triangles);
  const BandParts parts = PartsInBand(site, stand, triangles);
  const Overhead overhead({&triangles});
  const Roofs is_solid(site, stand.ground(0), overhead);
  shape.lines = static_cast<int>(parts.walls.size() + parts.areas.size());
  shape.solid = parts.areas;
  const std::vector<Segment> lines = Outside(parts.walls, parts.areas);
  Close(lines, site.options.bridge_m, is_solid, &shape);
  if (object.kind == ObstacleKind::kBuilding && shape.open_m > kOpenShell_m) {
    const double before = Area(shape.solid);
    Close(shape.loose, kNoWay_m, is_solid, &shape);
    shape.guessed |= Area(shape.solid) > before + kSmallestGap_m2;
  }
  return shape;
}

// What neither the building's own walls nor its block's have closed.
void CloseRooms(const Site& site, const TownObject& object, Shape* shape) {
  if (object.kind != ObstacleKind::kBuilding || shape->open_m <= kOpenShell_m) return;
  const Stand stand(site, object);
  const Overhead overhead({&object.triangles});
  const Roofs is_solid(site, stand.ground(0), overhead);
  Rings rooms = RoomsWithOneMouth(shape->loose, shape->solid, std::max(site.options.bridge_m, kCrumb_m), is_solid);
  if (rooms.empty()) rooms = RoomsWithOneMouth(shape->loose, shape->solid, kNoWay_m, is_solid);
  if (rooms.empty()) return;
  Rings all = shape->solid;
  all.insert(all.end(), rooms.begin(), rooms.end());
  shape->solid = UnionOfAreas(all);
  shape->guessed = true;
  SetLoose(std::vector<Segment>(shape->loose), shape);
}

bool Adjoin(const TownObject& a, const TownObject& b) {
  const auto apart = [](double a_max, double b_min) { return b_min > a_max + kBlockReach_m; };
  return !(apart(a.max_m.x, b.min_m.x) || apart(b.max_m.x, a.min_m.x) || apart(a.max_m.y, b.min_m.y) ||
           apart(b.max_m.y, a.min_m.y));
}

// Groups of objects whose boxes lie within reach of each other, each in order.
std::vector<std::vector<size_t>> Blocks(const std::vector<TownObject>& objects) {
  std::vector<size_t> parent(objects.size());
  std::iota(parent.begin(), parent.end(), size_t{0});
  const auto root = [&](size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::vector<size_t> from_west;
  for (size_t i = 0; i < objects.size(); ++i)
    if (InBlocks(objects[i].kind)) from_west.push_back(i);
  std::sort(from_west.begin(), from_west.end(), [&](size_t i, size_t j) { return objects[i].min_m.x < objects[j].min_m.x; });
  for (size_t k = 0; k < from_west.size(); ++k) {
    const size_t i = from_west[k];
    for (size_t l = k + 1; l < from_west.size(); ++l) {
      const size_t j = from_west[l];
      if (objects[j].min_m.x > objects[i].max_m.x + kBlockReach_m) break;
      if (!Adjoin(objects[i], objects[j])) continue;
      const size_t ri = root(i), rj = root(j);
      parent[std::max(ri, rj)] = std::min(ri, rj);
    }
  }
  std::map<size_t, std::vector<size_t>> groups;
  for (size_t i = 0; i < objects.size(); ++i) groups[root(i)].push_back(i);
  std::vector<std::vector<size_t>> blocks;
  for (auto& [_, members] : groups) blocks.push_back(std::move(members));
  return blocks;
}

bool NearBox(const TownObject& object, const Ring& ring) {
  return std::any_of(ring.begin(), ring.end(), [&](const Point2& p) {
    return p.x >= object.min_m.x && p.x <= object.max_m.x && p.y >= object.min_m.y && p.y <= object.max_m.y;
  });
}

Rings Projection(const TownObject& object) {
  Rings rings;
  for (const Triangle3& t : object.triangles) {
    Ring ring{{t[0].x, t[0].y}, {t[1].x, t[1].y}, {t[2].x, t[2].y}};
    if (std::abs(SignedArea(ring)) > 1e-6) rings.push_back(std::move(ring));
  }
  return UnionOfRings(rings);
}

// Of a block, the objects that something is missing from, and those beside them.
std::vector<size_t> OpenOnes(const std::vector<TownObject>& objects, const std::vector<size_t>& block,
                             const std::vector<Shape>& shapes) {
  std::vector<size_t> open;
  for (const size_t i : block) {
    const bool touched = std::any_of(block.begin(), block.end(), [&](size_t j) {
      return shapes[j].open_m > kOpenShell_m && Adjoin(objects[i], objects[j]);
    });
    if (touched) open.push_back(i);
  }
  return open;
}

// One object of several, as far as the ground under them is concerned.
TownObject Together(const std::vector<TownObject>& objects, const std::vector<size_t>& block) {
  TownObject all = objects[block[0]];
  for (size_t k = 1; k < block.size(); ++k) {
    const TownObject& o = objects[block[k]];
    all.triangles.insert(all.triangles.end(), o.triangles.begin(), o.triangles.end());
    all.foundation.insert(all.foundation.end(), o.foundation.begin(), o.foundation.end());
    all.min_m = {std::min(all.min_m.x, o.min_m.x), std::min(all.min_m.y, o.min_m.y), std::min(all.min_m.z, o.min_m.z)};
    all.max_m = {std::max(all.max_m.x, o.max_m.x), std::max(all.max_m.y, o.max_m.y), std::max(all.max_m.z, o.max_m.z)};
  }
  return all;
}

// Houses that lean on each other often lack the wall between them: what only the block as a whole encloses goes to the
// house that stands over it.
void ShareBlock(const Site& site, const std::vector<TownObject>& objects, const std::vector<size_t>& whole_block,
                std::vector<Shape>* shapes) {
  const std::vector<size_t> block = OpenOnes(objects, whole_block, *shapes);
  if (block.empty()) return;
  std::vector<Segment> lines;
  Rings known;
  std::vector<const std::vector<Triangle3>*> triangles;
  for (const size_t i : block) {
    const Shape& own = (*shapes)[i];
    lines.insert(lines.end(), own.loose.begin(), own.loose.end());
    known.insert(known.end(), own.solid.begin(), own.solid.end());
    triangles.push_back(&objects[i].triangles);
  }
  known = UnionOfAreas(known);
  Shape whole;
  whole.solid = known;
  const Stand stand(site, Together(objects, block));
  const Overhead overhead(triangles);
  Close(lines, site.options.bridge_m, Roofs(site, stand.ground(0), overhead), &whole);
  Rings gap = Difference(whole.solid, known);
  // A piece goes to the object that most of it lies under.
  std::vector<Rings> projections(block.size());
  for (const Polygon& piece : ToPolygons(gap)) {
    Rings rings{piece.outer};
    rings.insert(rings.end(), piece.holes.begin(), piece.holes.end());
    if (Area(rings) < kSmallestGap_m2) continue;
    size_t owner = block.size();
    double most = 0;
    for (size_t k = 0; k < block.size(); ++k) {
      if (!NearBox(objects[block[k]], piece.outer)) continue;
      if (projections[k].empty()) projections[k] = Projection(objects[block[k]]);
      const double under = Area(Intersection(rings, projections[k]));
      if (under > most) most = under, owner = k;
    }
    if (owner == block.size()) continue;
    Shape& shape = (*shapes)[block[owner]];
    shape.solid = Union(shape.solid, rings);
    SetLoose(std::vector<Segment>(shape.loose), &shape);
  }
}

// Hollow walls and slits between houses: yards that nobody can stand in are none.
Rings WithoutSlits(Rings rings) {
  std::erase_if(rings, [](const Ring& ring) {
    return SignedArea(ring) < 0 && Offset({Ring(ring.rbegin(), ring.rend())}, -kSlit_m / 2).empty();
  });
  return rings;
}

Rings Enlarged(const Site& site, const Shape& shape) {
  const double clearance = site.options.clearance_m, tolerance = site.options.tolerance_m;
  Rings rings = WithoutSlits(clearance > 0 ? Offset(shape.solid, clearance) : shape.solid);
  const std::vector<Segment> thin =
      shape.loose.empty() ? shape.loose : Outside(shape.loose, Offset(shape.solid, kOnOutline_m));
  if (!thin.empty()) rings = WithoutSlits(Union(rings, OffsetSegments(thin, std::max(clearance, kThinWall_m))));
  return tolerance > 0 ? Simplify(rings, tolerance) : rings;
}

bool MakeCircle(const Site& site, const TownObject& object, Obstacle* obstacle) {
  const Stand stand(site, object);
  obstacle->ground_z_m = GroundInTheMiddle(stand, object);
  const std::vector<Segment> lines = Lines(PartsInBand(site, stand, object.triangles));
  BoundingBox box;
  for (const Segment& s : lines) {
    box.min = {std::min({box.min.x, s.a.x, s.b.x}), std::min({box.min.y, s.a.y, s.b.y})};
    box.max = {std::max({box.max.x, s.a.x, s.b.x}), std::max({box.max.y, s.a.y, s.b.y})};
  }
  if (lines.empty()) {
    if (object.radius_m <= 0) return false;
    box.min = {object.min_m.x, object.min_m.y}, box.max = {object.max_m.x, object.max_m.y};
  }
  obstacle->center = {(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2};
  double radius = object.radius_m;
  if (radius <= 0) {
    for (const Segment& s : lines)
      for (const Point2& p : {s.a, s.b})
        radius = std::max(radius, std::hypot(p.x - obstacle->center.x, p.y - obstacle->center.y));
  }
  obstacle->radius_m = radius + site.options.clearance_m;
  return true;
}

class NameGiver {
 public:
  std::string Unique(const std::string& wish) {
    std::string name = wish;
    for (int i = 2; !used_.insert(name).second; ++i) name = wish + "_" + std::to_string(i);
    return name;
  }

 private:
  std::set<std::string> used_;
};

Obstacle Blank(const Site& site, const TownObject& object) {
  Obstacle obstacle;
  obstacle.kind = object.kind;
  obstacle.source = object.name;
  obstacle.clearance_m = site.options.clearance_m;
  return obstacle;
}

Error CheckOptions(const FootprintOptions& options) {
  if (!(options.clearance_m >= 0)) return Fail("the clearance must not be negative");
  if (!(options.tolerance_m >= 0)) return Fail("the tolerance must not be negative");
  if (!(options.bridge_m >= 0)) return Fail("the bridging distance must not be negative");
  if (!(options.scale > 0) || !std::isfinite(options.scale)) return Fail("the scale must be greater than zero");
  if (options.threads < 0) return Fail("the number of threads must not be negative");
  if (!(options.band_m[0] >= 0 && options.band_m[0] < options.band_m[1]))
    return Fail("the band must be two heights, the lower first, neither negative");
  return Ok();
}

Error CheckExtents(const TownObjects& town) {
  for (const TownObject& o : town.obstacles) {
    const double width = std::max(o.max_m.x - o.min_m.x, o.max_m.y - o.min_m.y);
    if (!(width <= kLargestObject_m))
      return Fail("'" + o.name + "' is " + std::to_string(static_cast<int64_t>(std::min(width / 1000, 1e15))) + " km wide, more than 100 km; are its units metres? See the option for the scale");
  }
  return Ok();
}

// Houses as wide as villages or as narrow as boxes: the units are likely others.
void WarnOfUnits(const TownObjects& town, std::vector<std::string>* warnings) {
  std::vector<double> widths;
  for (const TownObject& o : town.obstacles)
    if (o.kind == ObstacleKind::kBuilding) widths.push_back(std::max(o.max_m.x - o.min_m.x, o.max_m.y - o.min_m.y));
  if (widths.empty()) return;
  std::nth_element(widths.begin(), widths.begin() + static_cast<long>(widths.size() / 2), widths.end());
  const double middle = widths[widths.size() / 2];
  if (middle > kNarrowestHouse_m && middle < kWidestHouse_m) return;
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", middle);
  warnings->push_back("half of the buildings are " + std::string(middle < 1 ? "narrower" : "wider") + " than " + text +
                      " m; are the units metres? See the option for the scale");
}

bool IsOpen(const TownObject& object, const Shape& shape) {
  return object.kind == ObstacleKind::kBuilding && (shape.guessed || shape.open_m > kOpenShell_m);
}

void MergeBlock(const std::vector<size_t>& block, std::vector<Shape>* shapes) {
  Shape& first = (*shapes)[block[0]];
  for (size_t k = 1; k < block.size(); ++k) {
    Shape& other = (*shapes)[block[k]];
    first.solid = Union(first.solid, other.solid);
    first.loose.insert(first.loose.end(), other.loose.begin(), other.loose.end());
    other.solid.clear(), other.loose.clear();
  }
}

void AddPolygons(const Site& site, const TownObject& object, double ground_z_m, const Rings& rings, NameGiver* names,
                 Footprints* footprints) {
  std::vector<Polygon> polygons = ToPolygons(rings);
  std::sort(polygons.begin(), polygons.end(),
            [](const Polygon& a, const Polygon& b) { return SignedArea(a.outer) > SignedArea(b.outer); });
  for (const Polygon& polygon : polygons) {
    if (SignedArea(polygon.outer) < kSmallestPiece_m2) continue;
    Obstacle obstacle = Blank(site, object);
    obstacle.name = names->Unique(object.name);
    obstacle.ground_z_m = ground_z_m;
    obstacle.outer = polygon.outer;
    for (const Ring& hole : polygon.holes)
      if (-SignedArea(hole) >= kSmallestPiece_m2) obstacle.holes.push_back(hole);
    footprints->obstacles.push_back(std::move(obstacle));
  }
}

}  // namespace

Error ExtractFootprints(const Scene& scene, const FootprintOptions& options, Footprints* footprints,
                        FootprintStats* stats, std::vector<std::string>* warnings) {
  if (Error error = CheckOptions(options)) return error;
  const TownObjects town = SortTown(scene, options.scale);
  if (town.ground.empty() && town.obstacles.empty()) return Fail("the town has neither ground nor obstacles");
  if (Error error = CheckExtents(town)) return error;
  if (warnings) WarnOfUnits(town, warnings);
  GroundRaster raster;
  std::optional<LocalGround> ground;
  if (!town.ground.empty()) {
    if (Error error = RasterizeGround(town, {}, &raster)) return error;
    ground.emplace(raster);
  }
  const Site site{options, ground ? &*ground : nullptr};

  *footprints = {};
  footprints->clearance_m = options.clearance_m;
  footprints->band_m = options.band_m;
  footprints->origin_m = {scene.origin_m.x * options.scale, scene.origin_m.y * options.scale};
  footprints->reference_system = scene.reference_system;
  FootprintStats counts;
  std::vector<Shape> shapes(town.obstacles.size());
  const auto is_round = [](const TownObject& o) {
    return o.kind == ObstacleKind::kTree || o.kind == ObstacleKind::kLamp;
  };
  ForEach(shapes.size(), options.threads, [&](size_t i) {
    if (!is_round(town.obstacles[i])) shapes[i] = ShapeOf(site, town.obstacles[i]);
  });
  for (size_t i = 0; i < shapes.size(); ++i) {
    counts.triangles += static_cast<int>(town.obstacles[i].triangles.size());
    counts.lines += shapes[i].lines;
  }
  const std::vector<std::vector<size_t>> blocks = Blocks(town.obstacles);
  for (const std::vector<size_t>& block : blocks)
    if (block.size() > 1) ShareBlock(site, town.obstacles, block, &shapes);
  ForEach(shapes.size(), options.threads, [&](size_t i) { CloseRooms(site, town.obstacles[i], &shapes[i]); });
  std::set<size_t> merged_open;  // blocks by their first object
  for (const std::vector<size_t>& block : blocks) {
    if (block.size() < 2 || !options.merge_blocks) continue;
    if (std::any_of(block.begin(), block.end(), [&](size_t i) { return IsOpen(town.obstacles[i], shapes[i]); }))
      merged_open.insert(block[0]);
    MergeBlock(block, &shapes);
  }
  std::vector<Rings> enlarged(shapes.size());
  ForEach(shapes.size(), options.threads, [&](size_t i) { enlarged[i] = Enlarged(site, shapes[i]); });
  // Without a clearance thin walls are as thin as slivers.
  SeparateObstacles(town.obstacles, shapes, options.clearance_m > kSliver_m ? kSliver_m : kThinWall_m, options.threads, &enlarged);

  for (size_t i = 0; i < shapes.size(); ++i)
    if (IsOpen(town.obstacles[i], shapes[i]))
      counts.open_shells.push_back(town.obstacles[i].name);

  NameGiver names;
  for (size_t i = 0; i < shapes.size(); ++i) {
    const TownObject& object = town.obstacles[i];
    const size_t before = footprints->obstacles.size();
    if (is_round(object)) {
      Obstacle circle = Blank(site, object);
      if (MakeCircle(site, object, &circle)) {
        circle.name = names.Unique(object.name);
        footprints->obstacles.push_back(std::move(circle));
      }
    } else {
      AddPolygons(site, object, shapes[i].ground_z_m, enlarged[i], &names, footprints);
      for (size_t k = before; k < footprints->obstacles.size(); ++k)
        footprints->obstacles[k].open_shell = IsOpen(object, shapes[i]) || merged_open.contains(i);
      counts.covered_m2 += Area(enlarged[i]);
    }
    if (footprints->obstacles.size() == before && shapes[i].lines == 0 && warnings)
      warnings->push_back("'" + object.name + "' leaves nothing in the way: it has no part between " +
                          std::to_string(options.band_m[0]) + " and " + std::to_string(options.band_m[1]) +
                          " m over the ground");
  }
  counts.objects = static_cast<int>(town.obstacles.size());
  counts.obstacles = static_cast<int>(footprints->obstacles.size());
  if (stats) *stats = counts;
  return Ok();
}

}  // namespace flaneur
