#include "pipeline/footprint/base_ground.h"

#include <algorithm>
#include <cmath>

#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/floors.h"
#include "pipeline/footprint/plan_raster.h"

namespace flaneur {
namespace {

void MarkKnown(GroundRaster* raster) {
  for (size_t i = 0; i < raster->kind.size(); ++i)
    if (raster->height_m[i] != kNoHeight) raster->kind[i] = static_cast<uint8_t>(GroundKind::kSquare);
}

GroundRaster Level(float height_m) {
  GroundRaster raster;
  raster.columns = raster.rows = 1;
  raster.height_m = {height_m};
  raster.kind = {static_cast<uint8_t>(GroundKind::kSquare)};
  return raster;
}

bool IsLevel(const std::vector<Triangle3>& foundation, GroundRaster* raster) {
  double lowest = kNoHeight, highest = -lowest;
  for (const Triangle3& t : foundation)
    for (const Point3& p : t) lowest = std::min(lowest, p.z), highest = std::max(highest, p.z);
  if (foundation.empty() || highest - lowest > kLevelGround_m) return false;
  *raster = Level(static_cast<float>(lowest));
  return true;
}

void Flatten(GroundRaster* raster) {
  float lowest = kNoHeight, highest = -kNoHeight;
  for (size_t i = 0; i < raster->kind.size(); ++i) {
    if (!raster->kind[i]) continue;
    lowest = std::min(lowest, raster->height_m[i]);
    highest = std::max(highest, raster->height_m[i]);
  }
  if (highest - lowest <= kLevelGround_m) *raster = Level(lowest);
}

GroundRaster Around(const TownObject& object, double margin_m) {
  return BlankRaster({object.min_m.x - margin_m, object.min_m.y - margin_m},
                     {object.max_m.x + margin_m, object.max_m.y + margin_m});
}

GroundRaster OfFoundation(const TownObject& object, const std::vector<Triangle3>& foundation) {
  GroundRaster raster = Around(object, 0);
  for (const Triangle3& t : foundation) DrawEdges(t, &raster), DrawArea(t, &raster);
  MarkKnown(&raster);
  return raster;
}

bool Reaches(const Triangle3& t, const GroundRaster& raster) {
  const auto [x0, x1] = std::minmax({t[0].x, t[1].x, t[2].x});
  const auto [y0, y1] = std::minmax({t[0].y, t[1].y, t[2].y});
  const double cell_m = raster.cell_m;
  return x1 >= raster.min_m.x && x0 <= raster.min_m.x + raster.columns * cell_m && y1 >= raster.min_m.y &&
         y0 <= raster.min_m.y + raster.rows * cell_m;
}

// Forgets what is farther than eaves reach from any cell that lies open to the sky: walls there stand on roofs.
void ForgetInside(const GroundRaster& cover, GroundRaster* feet) {
  GroundRaster open = cover;
  for (float& height : open.height_m) height = height == kNoHeight ? 1.0f : 0.0f;
  const int reach = static_cast<int>(std::ceil(kEaves_m / cover.cell_m));
  for (int column = 0; column < open.columns; ++column)
    open.height_m[CellAt(open, column, 0)] = open.height_m[CellAt(open, column, open.rows - 1)] = 1;
  for (int row = 0; row < open.rows; ++row)
    open.height_m[CellAt(open, 0, row)] = open.height_m[CellAt(open, open.columns - 1, row)] = 1;
  TakeGreatest(reach, &open);
  GroundRaster outer = *feet;
  bool any = false;
  for (size_t i = 0; i < outer.height_m.size(); ++i) {
    if (open.height_m[i] == 0) outer.height_m[i] = kNoHeight;
    any |= outer.height_m[i] != kNoHeight;
  }
  if (any) *feet = std::move(outer);
}

// Forgets walls that stand on roofs or hang from ceilings.
void ForgetOnFaces(const std::vector<const Triangle3*>& faces, GroundRaster* feet) {
  const float lowest = *std::min_element(feet->height_m.begin(), feet->height_m.end());
  GroundRaster outer = *feet;
  for (const Triangle3* t : faces) ForgetAt(*t, kFoot_m, lowest + static_cast<float>(kFoot_m), &outer);
  *feet = std::move(outer);
}

// An opening, as of greyscale pictures: narrow heights vanish, wide ones keep their borders.
GroundRaster OfFeet(const TownObject& object, const Neighbours& neighbours) {
  GroundRaster feet = Around(object, 2 * kBaseCell_m), cover = feet;
  bool any_wall = false;
  std::vector<const Triangle3*> faces;
  const auto draw = [&](const Triangle3& t) {
    if (!Reaches(t, feet)) return;
    if (!IsWall(t)) return faces.push_back(&t), DrawArea(t, &cover);
    any_wall = true;
    DrawEdges(t, &feet);
  };
  for (const Triangle3& t : object.triangles) draw(t);
  for (const TownObject* neighbour : neighbours)
    for (const Triangle3& t : neighbour->triangles) draw(t);
  if (!any_wall)
    for (const Triangle3& t : object.triangles) DrawEdges(t, &feet);
  ForgetInside(cover, &feet);
  if (any_wall) ForgetOnFaces(faces, &feet);
  MarkKnown(&feet);
  FillGaps(&feet);
  const int reach = static_cast<int>(std::ceil(kOverhang_m / feet.cell_m));
  TakeLeast(reach, &feet);
  TakeGreatest(reach, &feet);
  return feet;
}

}  // namespace

std::vector<Neighbours> NeighboursOf(const std::vector<TownObject>& objects,
                                     const std::vector<std::vector<size_t>>& adjoining) {
  std::vector<Neighbours> neighbours(objects.size());
  for (size_t i = 0; i < objects.size(); ++i)
    for (const size_t j : adjoining[i]) neighbours[i].push_back(&objects[j]);
  return neighbours;
}

std::vector<Neighbours> TellingOfGround(const std::vector<TownObject>& objects,
                                        const std::vector<std::vector<size_t>>& adjoining) {
  std::vector<Neighbours> neighbours = NeighboursOf(objects, adjoining);
  for (size_t i = 0; i < objects.size(); ++i)
    if (!objects[i].foundation.empty()) neighbours[i].clear();
  return neighbours;
}

GroundRaster BaseOf(const TownObject& object, const Neighbours& neighbours) {
  std::vector<Triangle3> floor;
  if (object.foundation.empty() && !object.has_no_floor) floor = FloorOf(object.triangles, kMinFloor);
  const std::vector<Triangle3>& foundation = object.foundation.empty() ? floor : object.foundation;
  return foundation.empty() ? OfFeet(object, neighbours) : OfFoundation(object, foundation);
}

std::vector<LocalGround> GroundsUnder(const TownObject& object, const Neighbours& neighbours) {
  GroundRaster low;
  if (object.foundation.empty() && object.level_feet_m) low = Level(static_cast<float>(*object.level_feet_m));
  else if (!IsLevel(object.foundation, &low)) low = BaseOf(object, neighbours);
  Flatten(&low);
  GroundRaster high = low;
  TakeGreatest(1, &high);
  bool step = false;
  for (size_t i = 0; i < low.kind.size(); ++i)
    step |= low.kind[i] && high.height_m[i] - low.height_m[i] > kMinTerraceStep_m;
  std::vector<LocalGround> grounds;
  grounds.emplace_back(low, LocalGround::Gaps::kNearest);
  if (step) grounds.emplace_back(high, LocalGround::Gaps::kNearest);
  return grounds;
}

}  // namespace flaneur
