#include "pipeline/footprint/extract_footprints.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <set>

#include "pipeline/footprint/blocks.h"
#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/feet.h"
#include "pipeline/footprint/for_each.h"
#include "pipeline/footprint/left_out.h"
#include "pipeline/footprint/lost_triangles.h"
#include "pipeline/footprint/object_shape.h"
#include "pipeline/footprint/separate_obstacles.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

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
    if (!(width <= kMaxObject_m))
      return Fail("'" + o.name + "' is " + std::to_string(static_cast<int64_t>(std::min(width / 1000, 1e15))) +
                  " km wide, more than 100 km; are its units metres? See the option for the scale");
  }
  return Ok();
}

// The one below which `share` of them lie.
double Quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<long>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Houses as wide as villages, as high as mountains, as narrow as boxes or all lower than a person: the units are likely
// others. Empty where nothing speaks for it.
std::string DoubtOfUnits(const TownObjects& town) {
  std::vector<double> widths, heights;
  for (const TownObject& o : town.obstacles) {
    if (o.kind != ObstacleKind::kBuilding) continue;
    widths.push_back(std::max(o.max_m.x - o.min_m.x, o.max_m.y - o.min_m.y));
    heights.push_back(o.max_m.z - o.min_m.z);
  }
  if (widths.empty()) return "";
  const bool one = widths.size() == 1;
  const double width = Quantile(widths, 0.5), height = Quantile(heights, 0.5);
  const double large = std::max(Quantile(widths, 0.9), Quantile(heights, 0.9));
  const double widest = one ? kMaxOfOne_m : kMaxHouse_m, highest = one ? kMaxOfOne_m / 10 : kMaxHeight_m;
  const auto doubt = [](const char* which, double size_m) {
    char text[160];
    std::snprintf(text, sizeof text, "%s than %.3g m; are the units metres? See the option for the scale", which,
                  size_m);
    return std::string(text);
  };
  if (width < kMinHouse_m) return doubt("half of the buildings are narrower", width);
  if (large < kMinLargest_m) return doubt("nine in ten of the buildings are narrower and lower", large);
  if (width > widest) return doubt("half of the buildings are wider", width);
  if (height > highest) return doubt("half of the buildings are higher", height);
  return "";
}

bool IsRound(const TownObject& object) {
  return object.kind == ObstacleKind::kTree || object.kind == ObstacleKind::kLamp;
}

std::vector<Shape> ShapesOf(const Site& site, const std::vector<TownObject>& objects,
                            const std::vector<Neighbours>& neighbours) {
  std::vector<Shape> shapes(objects.size());
  ForEach(shapes.size(), site.options.threads, [&](size_t i) {
    if (!IsRound(objects[i])) shapes[i] = ShapeOf(site, objects[i], neighbours[i]);
  });
  return shapes;
}

// Closes what is open in the buildings' shells, each with its neighbours and then by itself; says which were open.
void CloseShells(const Site& site, const std::vector<TownObject>& objects, const std::vector<Block>& blocks,
                 const std::vector<Neighbours>& beside, const std::vector<Neighbours>& neighbours, bool has_lost,
                 std::vector<Shape>* shapes) {
  ForEach(blocks.size(), site.options.threads, [&](size_t k) { ShareBlock(site, objects, blocks[k], shapes); });
  ForEach(shapes->size(), site.options.threads, [&](size_t i) {
    Shape& shape = (*shapes)[i];
    CloseRooms(site, objects[i], neighbours[i], &shape);
    CloseGround(site, objects[i], beside[i], has_lost, &shape);
    shape.open_shell = objects[i].kind == ObstacleKind::kBuilding && (shape.guessed || shape.open_m > kMaxOpenShell_m);
  });
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
  if (!thin.empty()) {
    Rings walls = OffsetSegments(thin, std::max(clearance, kThinSeam_m));
    if (clearance < kThinWall_m)
      walls = Union(walls, OffsetSegments(Outside(thin, Offset(shape.solid, 2 * kThinWall_m)), kThinWall_m));
    rings = WithoutSlits(Union(rings, walls));
  }
  return tolerance > 0 ? Simplify(rings, tolerance) : rings;
}

// Each with its clearance, none in another.
std::vector<Rings> Outlines(const Site& site, const std::vector<TownObject>& objects,
                            const std::vector<Shape>& shapes) {
  std::vector<Rings> outlines(shapes.size());
  ForEach(shapes.size(), site.options.threads, [&](size_t i) { outlines[i] = Enlarged(site, shapes[i]); });
  // Without a clearance what lies beside a house by a hair is as thin as slivers.
  const double width_m = site.options.clearance_m > kSliver_m ? kSliver_m : kThinSeam_m;
  SeparateObstacles(objects, shapes, width_m, site.options.threads, &outlines);
  return outlines;
}

Obstacle Blank(const Site& site, const TownObject& object) {
  Obstacle obstacle;
  obstacle.kind = object.kind;
  obstacle.source = object.name;
  obstacle.clearance_m = site.options.clearance_m;
  return obstacle;
}

BoundingBox BoundingBoxOf(const std::vector<Segment>& lines) {
  BoundingBox box;
  for (const Segment& s : lines) {
    box.min = {std::min({box.min.x, s.a.x, s.b.x}), std::min({box.min.y, s.a.y, s.b.y})};
    box.max = {std::max({box.max.x, s.a.x, s.b.x}), std::max({box.max.y, s.a.y, s.b.y})};
  }
  return box;
}

double FarthestEnd(const std::vector<Segment>& lines, Point2 center) {
  double radius = 0;
  for (const Segment& s : lines)
    for (const Point2& p : {s.a, s.b}) radius = std::max(radius, std::hypot(p.x - center.x, p.y - center.y));
  return radius;
}

// What of a tree or lamp is in the lower part of the band, above which crowns begin; else of all of the band.
std::vector<Segment> TrunkOf(const Site& site, const Stand& stand, const TownObject& object) {
  FootprintOptions options = site.options;
  options.band_m[1] = std::min(options.band_m[1], std::max(options.band_m[0] + kMinTrunk_m, kTrunkTop_m));
  const std::vector<Segment> trunk = Lines(PartsInBand({options, site.ground}, stand, object.triangles));
  return trunk.empty() ? Lines(PartsInBand(site, stand, object.triangles)) : trunk;
}

// Round the trunk; nothing where it neither has a part in the band nor says its radius.
std::optional<Obstacle> Circle(const Site& site, const TownObject& object) {
  const Stand stand(site, object);
  const std::vector<Segment> lines = TrunkOf(site, stand, object);
  if (lines.empty() && object.radius_m <= 0) return std::nullopt;
  BoundingBox box = BoundingBoxOf(lines);
  if (lines.empty()) box = {{object.min_m.x, object.min_m.y}, {object.max_m.x, object.max_m.y}};
  Obstacle circle = Blank(site, object);
  circle.ground_z_m = GroundInTheMiddle(stand, object);
  circle.center = {(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2};
  const double radius_m = object.radius_m > 0 ? object.radius_m : FarthestEnd(lines, circle.center);
  circle.radius_m = radius_m + site.options.clearance_m;
  return circle;
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

// Of neighbours in a ring that are no farther apart than this one stays, unless the ring would cross itself.
Ring WithoutNearPoints(const Ring& ring, double near_m) {
  const auto near = [&](Point2 a, Point2 b) { return std::hypot(a.x - b.x, a.y - b.y) <= near_m; };
  Ring kept;
  for (const Point2& p : ring)
    if (kept.empty() || !near(kept.back(), p)) kept.push_back(p);
  while (kept.size() > 3 && near(kept.back(), kept.front())) kept.pop_back();
  if (kept.size() == ring.size() || kept.size() < 3) return ring;
  const std::vector<Polygon> parts = ToPolygons({kept});
  const bool is_simple = parts.size() == 1 && parts[0].holes.empty() && parts[0].outer.size() == kept.size();
  return is_simple ? kept : ring;
}

void AddPolygons(const Site& site, const TownObject& object, const Shape& shape, const Rings& rings, NameGiver* names,
                 std::vector<Obstacle>* obstacles) {
  std::vector<Polygon> polygons = ToPolygons(rings);
  std::sort(polygons.begin(), polygons.end(),
            [](const Polygon& a, const Polygon& b) { return SignedArea(a.outer) > SignedArea(b.outer); });
  for (const Polygon& polygon : polygons) {
    if (SignedArea(polygon.outer) < kMinPiece_m2) continue;
    Obstacle obstacle = Blank(site, object);
    obstacle.name = names->Unique(object.name);
    obstacle.ground_z_m = shape.ground_z_m;
    obstacle.open_shell = shape.open_shell;
    obstacle.outer = WithoutNearPoints(polygon.outer, kSamePoint_m);
    for (const Ring& hole : polygon.holes)
      if (-SignedArea(hole) >= kMinPiece_m2) obstacle.holes.push_back(WithoutNearPoints(hole, kSamePoint_m));
    obstacles->push_back(std::move(obstacle));
  }
}

std::vector<Obstacle> ObstaclesOf(const Site& site, const std::vector<TownObject>& objects,
                                  const std::vector<Shape>& shapes, const std::vector<Rings>& outlines,
                                  std::vector<bool>* has_obstacle) {
  std::vector<Obstacle> obstacles;
  has_obstacle->assign(objects.size(), false);
  NameGiver names;
  for (size_t i = 0; i < objects.size(); ++i) {
    const TownObject& object = objects[i];
    const size_t before = obstacles.size();
    if (!IsRound(object)) {
      AddPolygons(site, object, shapes[i], outlines[i], &names, &obstacles);
    } else if (std::optional<Obstacle> circle = Circle(site, object)) {
      circle->name = names.Unique(object.name);
      obstacles.push_back(std::move(*circle));
    }
    (*has_obstacle)[i] = obstacles.size() > before;
  }
  return obstacles;
}

FootprintStats Count(const std::vector<TownObject>& objects, const std::vector<Shape>& shapes) {
  FootprintStats stats;
  stats.objects = Count(objects);
  for (size_t i = 0; i < objects.size(); ++i) {
    stats.triangles += static_cast<int>(objects[i].triangles.size());
    stats.lines += shapes[i].lines;
    if (shapes[i].open_shell) stats.open_shells.push_back(objects[i].name);
  }
  return stats;
}

}  // namespace

Error ExtractFootprints(const Scene& scene, const FootprintOptions& options, Footprints* footprints,
                        FootprintStats* stats, std::vector<std::string>* warnings) {
  if (Error error = CheckOptions(options)) return error;
  TownObjects town = SortTown(scene, options.scale);
  const std::vector<TownObject>& objects = town.obstacles;
  if (town.ground.empty() && objects.empty()) return Fail("the town has neither ground nor obstacles");
  if (Error error = CheckExtents(town)) return error;
  const std::vector<std::vector<size_t>> adjoining = Adjoining(objects);
  const std::vector<Block> blocks = BlocksOf(adjoining);
  if (town.ground.empty()) FindLevelFeet(blocks, options.threads, &town.obstacles);
  FindFloors(options, kMinFloor, &town.obstacles);
  const std::string units = DoubtOfUnits(town);
  if (warnings && !units.empty()) warnings->push_back(units);
  GroundRaster raster;
  std::optional<LocalGround> ground;
  if (!town.ground.empty()) {
    GroundRasterOptions below_bridges;
    below_bridges.with_decks = false;
    if (Error error = RasterizeGround(town, below_bridges, &raster)) return error;
    ground.emplace(raster);
  }
  const Site site{options, ground ? &*ground : nullptr};

  const std::vector<Neighbours> beside = NeighboursOf(objects, adjoining);
  const std::vector<Neighbours> neighbours =
      site.ground ? std::vector<Neighbours>(objects.size()) : TellingOfGround(objects, adjoining);
  std::vector<Shape> shapes = ShapesOf(site, objects, neighbours);
  const bool has_lost = PutBackLost(site, blocks, neighbours, &town.obstacles, &shapes);
  CloseShells(site, objects, blocks, beside, neighbours, has_lost, &shapes);
  FootprintStats counts = Count(objects, shapes);
  counts.doubt_of_units = units;
  if (options.merge_blocks)
    for (const Block& block : blocks) MergeBlock(block, &shapes);
  const std::vector<Rings> outlines = Outlines(site, objects, shapes);

  *footprints = {};
  footprints->clearance_m = options.clearance_m;
  footprints->tolerance_m = options.tolerance_m;
  footprints->band_m = options.band_m;
  footprints->origin_m = {scene.origin_m.x * options.scale, scene.origin_m.y * options.scale};
  footprints->reference_system = scene.reference_system;
  std::vector<bool> has_obstacle;
  footprints->obstacles = ObstaclesOf(site, objects, shapes, outlines, &has_obstacle);
  if (warnings) WarnOfLeftOut(site, town, shapes, outlines, has_obstacle, warnings);
  counts.obstacles = Count(footprints->obstacles);
  for (const Rings& outline : outlines) counts.covered_m2 += Area(outline);
  if (stats) *stats = counts;
  return Ok();
}

}  // namespace flaneur
