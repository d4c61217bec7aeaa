#include "pipeline/footprint/base_ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/footprint/constants.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kNothing = std::numeric_limits<float>::max();

GroundRaster Blank(const TownObject& object) {
  GroundRaster raster;
  const double width = object.max_m.x - object.min_m.x, depth = object.max_m.y - object.min_m.y;
  double cell = kBaseCell_m;
  while ((width / cell + 2) * (depth / cell + 2) > kMaxBaseCells) cell *= 2;
  raster.cell_m = static_cast<float>(cell);
  raster.min_m = {static_cast<float>(std::floor(object.min_m.x / cell) * cell),
                  static_cast<float>(std::floor(object.min_m.y / cell) * cell)};
  raster.columns = static_cast<int>(std::floor((object.max_m.x - raster.min_m.x) / cell)) + 1;
  raster.rows = static_cast<int>(std::floor((object.max_m.y - raster.min_m.y) / cell)) + 1;
  const size_t cells = static_cast<size_t>(raster.columns) * static_cast<size_t>(raster.rows);
  raster.height_m.assign(cells, kNothing);
  raster.kind.assign(cells, 0);
  return raster;
}

size_t CellAt(const GroundRaster& raster, int column, int row) { return RowMajor(row, raster.columns, column); }

void LowerTo(GroundRaster* raster, double x, double y, double z) {
  const int column = static_cast<int>(std::floor((x - raster->min_m.x) / raster->cell_m));
  const int row = static_cast<int>(std::floor((y - raster->min_m.y) / raster->cell_m));
  if (column < 0 || row < 0 || column >= raster->columns || row >= raster->rows) return;
  float& height = raster->height_m[CellAt(*raster, column, row)];
  height = std::min(height, static_cast<float>(z));
}

void MarkKnown(GroundRaster* raster) {
  for (size_t i = 0; i < raster->kind.size(); ++i)
    if (raster->height_m[i] != kNothing) raster->kind[i] = static_cast<uint8_t>(GroundKind::kSquare);
}

std::vector<Triangle3> Walls(const std::vector<Triangle3>& triangles) {
  std::vector<Triangle3> walls;
  for (const Triangle3& t : triangles) {
    const auto& [a, b, c] = t;
    const double x = (b.y - a.y) * (c.z - a.z) - (b.z - a.z) * (c.y - a.y);
    const double y = (b.z - a.z) * (c.x - a.x) - (b.x - a.x) * (c.z - a.z);
    const double z = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (std::abs(z) < kMaxWallSlope * std::hypot(x, y, z)) walls.push_back(t);
  }
  return walls;
}

// The lowest point of the triangles' edges in each cell.
void DrawEdges(const std::vector<Triangle3>& triangles, GroundRaster* raster) {
  for (const Triangle3& t : triangles) {
    for (size_t i = 0; i < 3; ++i) {
      const Point3 &a = t[i], &b = t[(i + 1) % 3];
      const double length = std::hypot(b.x - a.x, b.y - a.y);
      const int steps = std::max(1, static_cast<int>(std::ceil(2 * length / raster->cell_m)));
      for (int k = 0; k <= steps; ++k) {
        const double s = static_cast<double>(k) / steps;
        LowerTo(raster, a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), a.z + s * (b.z - a.z));
      }
    }
  }
}

// The least value within `reach` cells along one line of cells, those without a value left out.
template <typename Better>
void FilterLine(std::vector<float>* line, int reach, Better better) {
  std::vector<int> queue;  // candidates, the best in front
  size_t front = 0;
  const std::vector<float> in = *line;
  const int n = Count(in);
  for (int i = 0, next = 0; i < n; ++i) {
    for (; next < n && next <= i + reach; ++next) {
      if (At(in, next) == kNothing) continue;
      while (queue.size() > front && !better(At(in, queue.back()), At(in, next))) queue.pop_back();
      queue.push_back(next);
    }
    while (front < queue.size() && queue[front] < i - reach) ++front;
    if (At(in, i) != kNothing && front < queue.size()) At(*line, i) = At(in, queue[front]);
  }
}

template <typename Better>
void Filter(GroundRaster* raster, int reach, Better better) {
  std::vector<float> line;
  for (int row = 0; row < raster->rows; ++row) {
    const auto begin = raster->height_m.begin() + static_cast<long>(CellAt(*raster, 0, row));
    line.assign(begin, begin + raster->columns);
    FilterLine(&line, reach, better);
    std::copy(line.begin(), line.end(), begin);
  }
  line.resize(static_cast<size_t>(raster->rows));
  for (int column = 0; column < raster->columns; ++column) {
    for (int row = 0; row < raster->rows; ++row) At(line, row) = raster->height_m[CellAt(*raster, column, row)];
    FilterLine(&line, reach, better);
    for (int row = 0; row < raster->rows; ++row) raster->height_m[CellAt(*raster, column, row)] = At(line, row);
  }
}

constexpr auto kLower = [](float a, float b) { return a < b; };
constexpr auto kHigher = [](float a, float b) { return a > b; };

GroundRaster Level(float height_m) {
  GroundRaster raster;
  raster.columns = raster.rows = 1;
  raster.height_m = {height_m};
  raster.kind = {static_cast<uint8_t>(GroundKind::kSquare)};
  return raster;
}

bool LevelFoundation(const TownObject& object, GroundRaster* raster) {
  double lowest = kNothing, highest = -kNothing;
  for (const Triangle3& t : object.foundation)
    for (const Point3& p : t) lowest = std::min(lowest, p.z), highest = std::max(highest, p.z);
  if (object.foundation.empty() || highest - lowest > kLevelGround_m) return false;
  *raster = Level(static_cast<float>(lowest));
  return true;
}

void Flatten(GroundRaster* raster) {
  float lowest = kNothing, highest = -kNothing;
  for (size_t i = 0; i < raster->kind.size(); ++i) {
    if (!raster->kind[i]) continue;
    lowest = std::min(lowest, raster->height_m[i]);
    highest = std::max(highest, raster->height_m[i]);
  }
  if (highest - lowest <= kLevelGround_m) *raster = Level(lowest);
}

}  // namespace

GroundRaster BaseOf(const TownObject& object) {
  GroundRaster raster = Blank(object);
  if (!object.foundation.empty()) {
    DrawEdges(object.foundation, &raster);
    MarkKnown(&raster);
  } else {
    // An opening, as of greyscale pictures: narrow heights vanish, wide ones keep their borders.
    const std::vector<Triangle3> walls = Walls(object.triangles);
    DrawEdges(walls.empty() ? object.triangles : walls, &raster);
    MarkKnown(&raster);
    FillGaps(&raster);
    const int reach = static_cast<int>(std::ceil(kOverhang_m / raster.cell_m));
    Filter(&raster, reach, kLower);
    Filter(&raster, reach, kHigher);
  }
  return raster;
}

std::vector<LocalGround> GroundsUnder(const TownObject& object) {
  GroundRaster low;
  if (!LevelFoundation(object, &low)) low = BaseOf(object);
  Flatten(&low);
  GroundRaster high = low;
  Filter(&high, 1, kHigher);
  bool step = false;
  for (size_t i = 0; i < low.kind.size(); ++i)
    step |= low.kind[i] && high.height_m[i] - low.height_m[i] > kMinTerraceStep_m;
  std::vector<LocalGround> grounds;
  grounds.emplace_back(low, LocalGround::Gaps::kNearest);
  if (step) grounds.emplace_back(high, LocalGround::Gaps::kNearest);
  return grounds;
}

}  // namespace flaneur
