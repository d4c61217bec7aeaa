#include "pipeline/footprint/extract_footprints.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "pipeline/footprint/band.h"
#include "pipeline/footprint/enclosed_regions.h"
#include "pipeline/footprint/overhead.h"
#include "pipeline/footprint/polygon_sets.h"
#include "pipeline/footprint/rasterize_ground.h"
#include "pipeline/footprint/town_objects.h"

namespace flaneur {
namespace {

constexpr double kBlockReach_m = 0.1;      // houses nearer than this are looked at together
constexpr double kRoofedShare = 0.5;       // of a region's area must lie under something
constexpr double kSmallestPiece_m2 = 0.01; // what clipping leaves over that is smaller is dropped
constexpr double kSmallestGap_m2 = 0.01;   // of a block that no single house accounts for
constexpr double kOpenShell_m = 1.0;       // of wall without anything solid beside it, in a building
constexpr double kThinWall_m = 0.001;      // half the thickness of a wall without any, before the clearance

// An object's part in the band.
struct Shape {
  std::vector<Segment> segments;
  Rings solid;
  std::vector<Segment> loose;  // walls without area
};

struct Site {
  const FootprintOptions& options;
  const LocalGround& ground;
};

RegionTest RoofedTest(const Site& site, const Overhead& overhead) {
  return [&](double area_m2, const std::vector<RegionSample>& samples) {
    if (area_m2 < site.options.open_yard_m2) return true;
    double roofed = 0, all = 0;
    for (const auto& [p, weight] : samples) {
      all += weight;
      if (overhead.Covers(p, site.ground.Height(p.x, p.y) + site.options.band_m[0])) roofed += weight;
    }
    return roofed > kRoofedShare * all;
  };
}

void Close(const Site& site, std::vector<Segment> segments, const Rings& areas, const Overhead& overhead,
           Shape* shape) {
  BridgeLooseEnds(&segments, site.options.bridge_m);
  Enclosure enclosure = EncloseRegions(segments, RoofedTest(site, overhead));
  shape->solid = Union(enclosure.solid, areas);
  shape->loose = Outside(enclosure.loose, Offset(areas, 0.001));
}

Shape ShapeOf(const Site& site, const TownObject& object) {
  Shape shape;
  const BandParts parts = CutToBand(object.triangles, site.ground, site.options.band_m);
  shape.segments = parts.segments;
  Overhead overhead;
  overhead.Add(object.triangles);
  Close(site, parts.segments, parts.areas, overhead, &shape);
  return shape;
}

// Groups of objects whose boxes lie within reach of each other, each in order.
std::vector<std::vector<size_t>> Blocks(const std::vector<TownObject>& objects) {
  std::vector<size_t> parent(objects.size());
  std::iota(parent.begin(), parent.end(), size_t{0});
  const auto root = [&](size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const auto apart = [](double a_max, double b_min) { return b_min > a_max + kBlockReach_m; };
  for (size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].kind != ObstacleKind::kBuilding) continue;
    for (size_t j = 0; j < i; ++j) {
      if (objects[j].kind != ObstacleKind::kBuilding) continue;
      const TownObject &a = objects[i], &b = objects[j];
      if (apart(a.max_m.x, b.min_m.x) || apart(b.max_m.x, a.min_m.x) || apart(a.max_m.y, b.min_m.y) ||
          apart(b.max_m.y, a.min_m.y))
        continue;
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

Rings Projection(const TownObject& object) {
  Rings rings;
  for (const Triangle3& t : object.triangles) {
    Ring ring{{t[0].x, t[0].y}, {t[1].x, t[1].y}, {t[2].x, t[2].y}};
    if (std::abs(SignedArea(ring)) > 1e-6) rings.push_back(std::move(ring));
  }
  return UnionOfRings(rings);
}

// Houses that lean on each other often lack the wall between them: what only the block as a whole encloses goes to the
// house that stands over it.
void ShareBlock(const Site& site, const std::vector<TownObject>& objects, const std::vector<size_t>& block,
                std::vector<Shape>* shapes) {
  std::vector<Segment> segments;
  Rings known;
  Overhead overhead;
  for (const size_t i : block) {
    const Shape& shape = (*shapes)[i];
    segments.insert(segments.end(), shape.segments.begin(), shape.segments.end());
    known = Union(known, shape.solid);
    overhead.Add(objects[i].triangles);
  }
  Shape whole;
  Close(site, segments, {}, overhead, &whole);
  Rings gap = Difference(whole.solid, known);
  for (const size_t i : block) {
    if (Area(gap) < kSmallestGap_m2) return;
    const Rings mine = Intersection(gap, Projection(objects[i]));
    if (Area(mine) < kSmallestGap_m2) continue;
    (*shapes)[i].solid = Union((*shapes)[i].solid, mine);
    gap = Difference(gap, mine);
  }
  if (Area(gap) >= kSmallestGap_m2) (*shapes)[block[0]].solid = Union((*shapes)[block[0]].solid, gap);
}

// Never less than the wall: the simplification's tolerance is given beforehand where the clearance does not hold it.
Rings Enlarged(const Site& site, const Shape& shape) {
  const double clearance = site.options.clearance_m, tolerance = site.options.tolerance_m;
  const double grow = std::max(clearance, tolerance);
  Rings rings = grow > 0 ? Offset(shape.solid, grow) : shape.solid;
  const std::vector<Segment> thin = Outside(shape.loose, Offset(shape.solid, 0.002));
  if (!thin.empty()) rings = Union(rings, OffsetSegments(thin, std::max(grow, kThinWall_m)));
  return tolerance > 0 ? Simplify(rings, tolerance) : rings;
}

struct Box { Point2 min{1e300, 1e300}, max{-1e300, -1e300}; };
Box BoxOf(const Rings& rings) {
  Box box;
  for (const Ring& ring : rings) {
    for (const Point2& p : ring) {
      box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y)};
      box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y)};
    }
  }
  return box;
}
bool Apart(const Box& a, const Box& b) {
  return a.max.x < b.min.x || b.max.x < a.min.x || a.max.y < b.min.y || b.max.y < a.min.y;
}

// Enlarged neighbours overlap by twice the clearance: each keeps clear of the others' walls, and of what the earlier
// ones have taken.
void Separate(const std::vector<Shape>& shapes, std::vector<Rings>* enlarged) {
  std::vector<Box> solid_boxes, boxes;
  for (const Shape& shape : shapes) solid_boxes.push_back(BoxOf(shape.solid));
  for (const Rings& rings : *enlarged) boxes.push_back(BoxOf(rings));
  for (size_t i = 0; i < enlarged->size(); ++i) {
    Rings taken;
    for (size_t j = 0; j < enlarged->size(); ++j) {
      if (j == i || (*enlarged)[j].empty()) continue;
      if (j < i && !Apart(boxes[i], boxes[j])) taken = Union(taken, (*enlarged)[j]);
      if (j > i && !Apart(boxes[i], solid_boxes[j])) taken = Union(taken, Difference(shapes[j].solid, shapes[i].solid));
    }
    if (!taken.empty()) (*enlarged)[i] = Difference((*enlarged)[i], taken);
  }
}

bool MakeCircle(const Site& site, const TownObject& object, Obstacle* obstacle) {
  const BandParts parts = CutToBand(object.triangles, site.ground, site.options.band_m);
  Box box;
  for (const Segment& s : parts.segments) {
    box.min = {std::min({box.min.x, s.a.x, s.b.x}), std::min({box.min.y, s.a.y, s.b.y})};
    box.max = {std::max({box.max.x, s.a.x, s.b.x}), std::max({box.max.y, s.a.y, s.b.y})};
  }
  if (parts.segments.empty()) {
    if (object.radius_m <= 0) return false;
    box.min = {object.min_m.x, object.min_m.y}, box.max = {object.max_m.x, object.max_m.y};
  }
  obstacle->center = {(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2};
  double radius = object.radius_m;
  if (radius <= 0) {
    for (const Segment& s : parts.segments)
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
  const double x = (object.min_m.x + object.max_m.x) / 2, y = (object.min_m.y + object.max_m.y) / 2;
  obstacle.ground_z_m = site.ground.Height(x, y);
  return obstacle;
}

Error CheckOptions(const FootprintOptions& options) {
  if (!(options.clearance_m >= 0)) return Fail("the clearance must not be negative");
  if (!(options.tolerance_m >= 0)) return Fail("the tolerance must not be negative");
  if (!(options.bridge_m >= 0)) return Fail("the bridging distance must not be negative");
  if (!(options.scale > 0) || !std::isfinite(options.scale)) return Fail("the scale must be greater than zero");
  if (!(options.band_m[0] >= 0 && options.band_m[0] < options.band_m[1]))
    return Fail("the band must be two heights, the lower first, neither negative");
  return Ok();
}

double LooseLength(const Shape& shape) {
  double length = 0;
  for (const Segment& s : Outside(shape.loose, Offset(shape.solid, 0.002))) length += std::hypot(s.b.x - s.a.x, s.b.y - s.a.y);
  return length;
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

void AddPolygons(const Site& site, const TownObject& object, const Rings& rings, NameGiver* names,
                 Footprints* footprints) {
  std::vector<Polygon> polygons = ToPolygons(rings);
  std::sort(polygons.begin(), polygons.end(),
            [](const Polygon& a, const Polygon& b) { return SignedArea(a.outer) > SignedArea(b.outer); });
  for (const Polygon& polygon : polygons) {
    if (SignedArea(polygon.outer) < kSmallestPiece_m2) continue;
    Obstacle obstacle = Blank(site, object);
    obstacle.name = names->Unique(object.name);
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
  GroundRaster raster;
  if (Error error = RasterizeGround(town, {}, &raster)) return error;
  const LocalGround ground(raster);
  const Site site{options, ground};

  *footprints = {};
  footprints->clearance_m = options.clearance_m;
  footprints->band_m = options.band_m;
  FootprintStats counts;
  std::vector<Shape> shapes(town.obstacles.size());
  const auto is_round = [](const TownObject& o) {
    return o.kind == ObstacleKind::kTree || o.kind == ObstacleKind::kLamp;
  };
  for (size_t i = 0; i < shapes.size(); ++i) {
    counts.triangles += static_cast<int>(town.obstacles[i].triangles.size());
    if (is_round(town.obstacles[i])) continue;
    shapes[i] = ShapeOf(site, town.obstacles[i]);
    counts.segments += static_cast<int>(shapes[i].segments.size());
  }
  for (const std::vector<size_t>& block : Blocks(town.obstacles)) {
    if (block.size() < 2) continue;
    ShareBlock(site, town.obstacles, block, &shapes);
    if (options.merge_blocks) MergeBlock(block, &shapes);
  }
  std::vector<Rings> enlarged;
  for (const Shape& shape : shapes) enlarged.push_back(Enlarged(site, shape));
  Separate(shapes, &enlarged);

  for (size_t i = 0; i < shapes.size(); ++i)
    if (town.obstacles[i].kind == ObstacleKind::kBuilding && LooseLength(shapes[i]) > kOpenShell_m)
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
      AddPolygons(site, object, enlarged[i], &names, footprints);
      counts.covered_m2 += Area(enlarged[i]);
    }
    if (footprints->obstacles.size() == before && warnings && !options.merge_blocks)
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
