#include "pipeline/footprint/bridges.h"

#include <algorithm>
#include <cmath>

#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/object_shape.h"
#include "pipeline/footprint/plan_raster.h"

namespace flaneur {
namespace {

// The height of the deck; tops narrower than a deck left out.
LocalGround DeckOf(const TownObject& bridge) {
  GroundRaster tops = BlankRaster({bridge.min_m.x, bridge.min_m.y}, {bridge.max_m.x, bridge.max_m.y});
  for (Triangle3 t : bridge.triangles) {
    if (IsWall(t)) continue;
    for (Point3& p : t) p.z = -p.z;  // the raster keeps the lowest
    DrawArea(t, &tops);
  }
  for (size_t i = 0; i < tops.kind.size(); ++i) {
    if (tops.height_m[i] == kNoHeight) continue;
    tops.height_m[i] = -tops.height_m[i];
    tops.kind[i] = static_cast<uint8_t>(GroundKind::kPavement);
  }
  const int reach = static_cast<int>(std::ceil(kMinDeck_m / 2 / tops.cell_m));
  TakeLeast(reach, &tops);
  TakeGreatest(reach, &tops);
  const bool any = std::any_of(tops.kind.begin(), tops.kind.end(), [](uint8_t kind) { return kind != 0; });
  if (!any) std::fill(tops.kind.begin(), tops.kind.end(), 1), tops.height_m.assign(tops.kind.size(), 0);
  return LocalGround(tops, LocalGround::Gaps::kNearest);
}

std::vector<Triangle3> WallsOf(const std::vector<Triangle3>& triangles) {
  std::vector<Triangle3> walls;
  std::copy_if(triangles.begin(), triangles.end(), std::back_inserter(walls), IsWall);
  return walls;
}

// What the lines enclose, in two sorts: pylons, and what is too wide for one.
struct Enclosure {
  Rings pylons, wide;
  std::vector<Segment> lines;
};
Enclosure Enclose(const Site& site, const BandParts& parts, const Roofs& under_deck) {
  Shape all;
  CloseUnderRoofs(parts.walls, site.options.bridge_m, under_deck, &all);
  Enclosure out;
  for (const Polygon& polygon : ToPolygons(all.solid)) {
    Rings rings{polygon.outer};
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
    Rings& sort = Offset(rings, -kMaxPylon_m / 2).empty() ? out.pylons : out.wide;
    sort.insert(sort.end(), rings.begin(), rings.end());
  }
  out.lines = std::move(all.loose);
  return out;
}

// Whether at this side of the deck, on it or a step before it, the ground is as high as the deck: its mouth.
bool LeadsOn(const Segment& side, const LocalGround& deck, const LocalGround& ground) {
  const Point2 middle{(side.a.x + side.b.x) / 2, (side.a.y + side.b.y) / 2};
  const double dx = side.b.x - side.a.x, dy = side.b.y - side.a.y;
  const double step = kDeckMouth_m / std::max(std::hypot(dx, dy), kDeckMouth_m / 1000);
  const double deck_m = deck.Height(middle.x, middle.y);
  for (const double off : {0.0, step, -step}) {
    const double ground_m = ground.Height(middle.x - dy * off, middle.y + dx * off);
    if (std::abs(deck_m - ground_m) <= kMaxDeckSlope_m) return true;
  }
  return false;
}

}  // namespace

Shape BridgeShape(const Site& site, const TownObject& bridge) {
  const Stand stand(site, bridge);
  const std::vector<Triangle3> walls = WallsOf(bridge.triangles);
  const Overhead overhead({&bridge.triangles});
  const LocalGround deck = DeckOf(bridge);
  Shape shape;
  shape.ground_z_m = GroundInTheMiddle(stand, bridge);
  // Below: parts too steep to walk on, over the ground under the bridge.
  const BandParts below_parts = CutToBand(walls, stand.ground(0), site.options.band_m);
  const Enclosure below = Enclose(site, below_parts, Roofs(site, stand.ground(0), overhead));
  const BandParts above_parts = CutToBand(walls, deck, site.options.band_m);
  const Enclosure above = Enclose(site, above_parts, Roofs(site, deck, overhead));
  shape.solid = below.pylons;
  shape.solid.insert(shape.solid.end(), above.pylons.begin(), above.pylons.end());
  shape.solid.insert(shape.solid.end(), above.wide.begin(), above.wide.end());
  shape.solid = UnionOfAreas(shape.solid);
  shape.lines = static_cast<int>(below_parts.walls.size() + above_parts.walls.size());
  std::vector<Segment> lines = above.lines;
  if (site.ground) {
    std::vector<Segment> sides = Outline(below.wide);
    sides.insert(sides.end(), below.lines.begin(), below.lines.end());
    for (const Segment& s : sides)
      if (!LeadsOn(s, deck, *site.ground)) lines.push_back(s);
  }
  SetLoose(lines, &shape);
  shape.open_m = 0;
  return shape;
}

}  // namespace flaneur
