#include "pipeline/footprint/object_shape.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "pipeline/footprint/bridges.h"
#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/disjoint_sets.h"
#include "pipeline/footprint/one_mouth.h"
#include "pipeline/footprint/repair_shell.h"
#include "pipeline/footprint/segment_grid.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

// Takes out the crumbs, which mostly stick out of an outline by a hair: connected pieces shorter than kMinLoosePiece_m
// together.
std::vector<Segment> TakeCrumbs(std::vector<Segment>* loose) {
  std::map<std::pair<double, double>, size_t> ends;
  DisjointSets connected;
  const auto end = [&](Point2 p) {
    const auto [entry, is_new] = ends.try_emplace({p.x, p.y}, connected.size());
    if (is_new) connected.Add();
    return entry->second;
  };
  std::vector<size_t> start;
  for (const Segment& s : *loose) {
    start.push_back(end(s.a));
    connected.Join(start.back(), end(s.b));
  }
  std::vector<double> length_m(connected.size(), 0);
  for (size_t i = 0; i < loose->size(); ++i) length_m[connected.Root(start[i])] += Length((*loose)[i]);
  std::vector<Segment> kept, crumbs;
  for (size_t i = 0; i < loose->size(); ++i)
    (length_m[connected.Root(start[i])] >= kMinLoosePiece_m ? kept : crumbs).push_back((*loose)[i]);
  *loose = std::move(kept);
  return crumbs;
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
                dangling |= Length(s) >= kMinLoosePiece_m;
                return Length(s) < kMinLoosePiece_m;
              }) > 0;
    if (dangling) return false;
  }
  *lines = std::move(kept);
  return true;
}

LocalGround Level(double height_m) {
  GroundRaster raster;
  raster.columns = raster.rows = 1;
  raster.height_m = {static_cast<float>(height_m)};
  raster.kind = {static_cast<uint8_t>(GroundKind::kSquare)};
  return LocalGround(raster);
}

// Segments that are asked whether a point lies on one of them.
class LineSet {
 public:
  explicit LineSet(std::vector<Segment> segments)
      : segments_(std::move(segments)),
        grid_(segments_, kMinLoosePiece_m, segments_.empty() ? kMaxCutCell_m : CellFor(segments_)) {}

  bool Pass(Point2 p) const {
    const std::vector<size_t>& near = grid_.Near(p);
    return std::any_of(near.begin(), near.end(), [&](size_t i) {
      return DistanceToSegment(p, segments_[i].a, segments_[i].b) < kMinLoosePiece_m;
    });
  }

 private:
  std::vector<Segment> segments_;
  SegmentGrid grid_;
};

// The share of a ring's length that runs along walls; where it runs along a joint without a wall it does not count.
double WalledShare(const Ring& ring, const LineSet& walls, const LineSet& joints) {
  constexpr double kStep_m = 0.5;
  double walled = 0, all = 0;
  for (const Segment& edge : Outline({ring})) {
    const int steps = std::max(1, static_cast<int>(Length(edge) / kStep_m));
    for (int k = 0; k < steps; ++k) {
      const double s = (k + 0.5) / steps;
      const Point2 p{edge.a.x + s * (edge.b.x - edge.a.x), edge.a.y + s * (edge.b.y - edge.a.y)};
      if (walls.Pass(p)) walled += Length(edge) / steps;
      else if (joints.Pass(p)) continue;
      all += Length(edge) / steps;
    }
  }
  return all > 0 ? walled / all : 1;
}

// Nobody gets into a hole. Where no walls bound it, parts of the building cover it, or the model says that the building
// stands there, it is none: some part lower than the band.
void FillHoles(const Site& site, const std::vector<Segment>& walls, const TownObject& object, Shape* shape) {
  if (std::none_of(shape->solid.begin(), shape->solid.end(), [](const Ring& r) { return SignedArea(r) < 0; })) return;
  // Under terrain the band's foot is known, and what it leaves open is open.
  const Rings ground = object.foundation_is_given ? InPlan(object.foundation)
                       : site.ground              ? Rings()
                                                  : InPlan(object.triangles);
  const LineSet all_walls(walls), no_joints({});
  const size_t filled = std::erase_if(shape->solid, [&](const Ring& ring) {
    if (SignedArea(ring) >= 0) return false;
    const Rings hole{Ring(ring.rbegin(), ring.rend())};
    return WalledShare(ring, all_walls, no_joints) < kMinWalledHole ||
           (!ground.empty() && Area(Difference(hole, ground)) < kMaxOffGround * Area(hole));
  });
  if (filled == 0) return;
  shape->solid = UnionOfAreas(shape->solid);
  SetLoose(std::vector<Segment>(shape->loose), shape);
}

// Walls that lean by a hair cover a hair of ground: where a house is nothing but such round a floor, they are lines.
void TakeStripsAsWalls(const TownObject& object, Shape* shape) {
  if (shape->solid.empty() || object.foundation.empty()) return;
  if (!Offset(shape->solid, -kStripe_m / 2).empty()) return;
  if (Area(InPlan(object.foundation)) < kMinFloorOfStrips * Area(shape->solid)) return;
  std::vector<Segment> lines = Outline(shape->solid);
  lines.insert(lines.end(), shape->loose.begin(), shape->loose.end());
  shape->solid.clear();
  SetLoose(lines, shape);
}

// Where a town has no other ground a floor that was found is the ground, and not in anybody's way.
std::vector<Triangle3> WithoutFloor(const Site& site, const TownObject& object, std::vector<Triangle3> triangles) {
  if (site.ground || object.foundation_is_given || object.foundation.empty()) return triangles;
  const auto before = [](const Triangle3& s, const Triangle3& t) {
    const auto less = [](const Point3& p, const Point3& q) {
      return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
    };
    return std::lexicographical_compare(s.begin(), s.end(), t.begin(), t.end(), less);
  };
  std::vector<Triangle3> floor = object.foundation;
  std::sort(floor.begin(), floor.end(), before);
  std::erase_if(triangles,
                [&](const Triangle3& t) { return std::binary_search(floor.begin(), floor.end(), t, before); });
  return triangles;
}

// Closes what is missing from a building's shell; whether that is something in the band.
bool Repair(const Site& site, const Stand& stand, const TownObject& object, std::vector<Triangle3>* triangles,
            int* lost_triangles) {
  if (object.kind != ObstacleKind::kBuilding) return false;
  std::vector<Triangle3> shell = object.triangles;
  shell.insert(shell.end(), object.foundation.begin(), object.foundation.end());
  const MissingFromShell missing = MissingTriangles(shell);
  *lost_triangles = missing.of_faces;
  triangles->insert(triangles->end(), missing.triangles.begin(), missing.triangles.end());
  return AnyInBand(site, stand, missing.triangles);
}

}  // namespace

void SetLoose(const std::vector<Segment>& lines, Shape* shape) { SetLoose(lines, shape->solid, shape); }

void SetLoose(const std::vector<Segment>& lines, const Rings& solid, Shape* shape) {
  shape->loose.clear();
  shape->open_m = 0;
  if (lines.empty()) return;
  shape->loose = Outside(lines, Offset(solid, kOnOutline_m));
  if (shape->loose.empty()) return;
  const Rings near = Offset(solid, kMinLoosePiece_m);  // covered with what is solid
  const std::vector<Segment> crumbs = TakeCrumbs(&shape->loose);
  for (const Segment& s : Outside(shape->loose, near)) shape->open_m += Length(s);
  for (const Segment& s : Outside(crumbs, near)) {
    shape->open_m += Length(s);
    shape->loose.push_back(s);
  }
}

Rings InPlan(const std::vector<Triangle3>& triangles) {
  Rings rings;
  for (const Triangle3& t : triangles) {
    Ring ring{{t[0].x, t[0].y}, {t[1].x, t[1].y}, {t[2].x, t[2].y}};
    if (std::abs(SignedArea(ring)) > 1e-6) rings.push_back(std::move(ring));
  }
  return Offset(Offset(UnionOfRings(rings), kSeamInPlan_m), -kSeamInPlan_m);
}

void CloseUnderRoofs(std::vector<Segment> lines, double reach_m, const Roofs& is_solid, Shape* shape) {
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

Shape ShapeOf(const Site& site, const TownObject& object, const Neighbours& neighbours) {
  if (object.is_bridge) return BridgeShape(site, object);
  const Stand stand(site, object, neighbours);
  Shape shape;
  shape.ground_z_m = GroundInTheMiddle(stand, object);
  std::vector<Triangle3> triangles = object.triangles;
  shape.guessed = Repair(site, stand, object, &triangles, &shape.lost_triangles);
  const BandParts parts = PartsInBand(site, stand, WithoutFloor(site, object, triangles));
  const Overhead overhead({&triangles});
  const Roofs is_solid(site, stand.ground(0), overhead);
  shape.lines = static_cast<int>(parts.walls.size() + parts.areas.size());
  shape.solid = parts.areas;
  const std::vector<Segment> lines = Outside(parts.walls, parts.areas);
  CloseUnderRoofs(lines, site.options.bridge_m, is_solid, &shape);
  if (object.kind == ObstacleKind::kBuilding && shape.open_m > kMaxOpenShell_m) {
    const double before = Area(shape.solid);
    CloseUnderRoofs(shape.loose, kNoWay_m, is_solid, &shape);
    shape.guessed |= Area(shape.solid) > before + kMinGap_m2;
  }
  if (object.kind == ObstacleKind::kBuilding)
    FillHoles(site, parts.walls, object, &shape), TakeStripsAsWalls(object, &shape);
  return shape;
}

void CloseRooms(const Site& site, const TownObject& object, const Neighbours& neighbours, Shape* shape) {
  if (object.kind != ObstacleKind::kBuilding || shape->open_m <= kMaxOpenShell_m) return;
  const Stand stand(site, object, neighbours);
  const Overhead overhead({&object.triangles});
  const Roofs is_solid(site, stand.ground(0), overhead);
  Rings rooms =
      RoomsWithOneMouth(shape->loose, shape->solid, std::max(site.options.bridge_m, kMinLoosePiece_m), is_solid);
  if (rooms.empty()) rooms = RoomsWithOneMouth(shape->loose, shape->solid, kNoWay_m, is_solid);
  if (rooms.empty()) return;
  Rings all = shape->solid;
  all.insert(all.end(), rooms.begin(), rooms.end());
  shape->solid = UnionOfAreas(all);
  shape->guessed = true;
  SetLoose(std::vector<Segment>(shape->loose), shape);
}

namespace {

void AppendEdges(const std::vector<Triangle3>& triangles, std::vector<Segment>* to) {
  for (const Triangle3& t : triangles)
    for (size_t i = 0; i < 3; ++i) {
      const Point3 &a = t[i], &b = t[(i + 1) % 3];
      if (a.x != b.x || a.y != b.y) to->push_back({{a.x, a.y}, {b.x, b.y}});
    }
}

Rings GroundsOf(const Neighbours& objects) {
  Rings grounds;
  for (const TownObject* object : objects) {
    const Rings ground = InPlan(object->foundation);
    grounds.insert(grounds.end(), ground.begin(), ground.end());
  }
  return grounds;
}

// A building's ground with what its edges, walls and the grounds beside it enclose under its roof: what was lost of it.
Rings WithNotches(Rings ground, const TownObject& object, const Neighbours& beside, const Rings& grounds_beside,
                  const Roofs& is_solid, std::vector<Segment> walls) {
  AppendEdges(object.foundation, &walls);
  for (const TownObject* other : beside) AppendEdges(other->foundation, &walls);
  const Rings enclosed = EncloseRegions(CutWhereTheyMeet(std::move(walls)), is_solid).solid;
  const Rings notches = Difference(enclosed, UnionOfAreas(grounds_beside));
  ground.insert(ground.end(), notches.begin(), notches.end());
  return Offset(Offset(UnionOfAreas(ground), kSeamInPlan_m), -kSeamInPlan_m);
}

void AppendWalls(const Site& site, const TownObject& object, std::vector<Segment>* to) {
  const std::vector<Segment> walls =
      Lines(PartsInBand(site, Stand(site, object), WithoutFloor(site, object, object.triangles)));
  to->insert(to->end(), walls.begin(), walls.end());
}

double LeastWalled(const TownObject& object, bool has_lost) {
  if (has_lost) return kMinWalledLost;
  return object.foundation_is_given ? kMinWalledGround : kMinWalledFloor;
}

}  // namespace

void CloseGround(const Site& site, const TownObject& object, const Neighbours& beside, bool has_lost, Shape* shape) {
  const bool is_lost = has_lost && shape->solid.empty();
  if (object.kind != ObstacleKind::kBuilding || object.foundation.empty()) return;
  if (shape->open_m <= kMaxOpenShell_m && !is_lost) return;
  const Point3& at = object.foundation[0][0];
  if (site.ground && std::abs(site.ground->Height(at.x, at.y) - at.z) > kSameGround_m) return;
  std::vector<Segment> walls = shape->loose;
  const std::vector<Segment> outline = Outline(shape->solid);
  walls.insert(walls.end(), outline.begin(), outline.end());
  if (is_lost) AppendWalls(site, object, &walls);  // those that lie against others' are none of the loose ones
  for (const TownObject* other : beside)           // one house may own the walls of all
    if (has_lost) AppendWalls(site, *other, &walls);
  if (walls.empty()) return;
  const Overhead overhead({&object.triangles});
  const LocalGround level = Level(at.z);
  const Roofs is_solid(site, level, overhead);
  Rings ground = InPlan(object.foundation), grounds_beside;
  if (has_lost) {
    grounds_beside = GroundsOf(beside);
    ground = WithNotches(std::move(ground), object, beside, grounds_beside, is_solid, walls);
  }
  const Rings open = Difference(ground, Offset(shape->solid, kOnOutline_m));
  if (open.empty()) return;
  if (!has_lost) grounds_beside = GroundsOf(beside);
  const LineSet all_walls(std::move(walls)), joints(Outline(grounds_beside));
  Rings all = shape->solid;
  for (const Polygon& polygon : ToPolygons(open)) {
    Rings rings{polygon.outer};
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
    if (Area(rings) < kMinClaim_m2 || !(has_lost || is_solid(rings))) continue;  // its roof may be among the lost
    if (WalledShare(polygon.outer, all_walls, joints) < LeastWalled(object, has_lost)) continue;
    all.insert(all.end(), rings.begin(), rings.end());
  }
  if (all.size() == shape->solid.size()) return;
  // Over the seams to what was solid before.
  shape->solid = Offset(Offset(UnionOfAreas(all), 2 * kOnOutline_m), -2 * kOnOutline_m);
  shape->guessed = true;
  SetLoose(std::vector<Segment>(shape->loose), shape);
}

}  // namespace flaneur
