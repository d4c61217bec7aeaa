#include "pipeline/footprint/plan_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/footprint/constants.h"

namespace flaneur {
namespace {

void LowerTo(int column, int row, double z, GroundRaster* raster) {
  if (column < 0 || row < 0 || column >= raster->columns || row >= raster->rows) return;
  float& height = raster->height_m[CellAt(*raster, column, row)];
  height = std::min(height, static_cast<float>(z));
}

// A line of cells, and what its filter needs.
struct Line {
  std::vector<float> cells, in;
  std::vector<int> queue;  // candidates, the best in front
};

// The best value within `reach` cells along one line of cells, those without a value left out.
template <typename Better>
void FilterLine(Line* filtered, int reach, Better better) {
  auto& [line, in, queue] = *filtered;
  queue.clear();
  size_t front = 0;
  in = line;
  const int n = Count(in);
  for (int i = 0, next = 0; i < n; ++i) {
    for (; next < n && next <= i + reach; ++next) {
      if (At(in, next) == kNoHeight) continue;
      while (queue.size() > front && !better(At(in, queue.back()), At(in, next))) queue.pop_back();
      queue.push_back(next);
    }
    while (front < queue.size() && queue[front] < i - reach) ++front;
    if (At(in, i) != kNoHeight && front < queue.size()) At(line, i) = At(in, queue[front]);
  }
}

template <typename Better>
void Filter(GroundRaster* raster, int reach, Better better) {
  Line line;
  for (int row = 0; row < raster->rows; ++row) {
    const auto begin = raster->height_m.begin() + static_cast<long>(CellAt(*raster, 0, row));
    line.cells.assign(begin, begin + raster->columns);
    FilterLine(&line, reach, better);
    std::copy(line.cells.begin(), line.cells.end(), begin);
  }
  line.cells.resize(static_cast<size_t>(raster->rows));
  for (int column = 0; column < raster->columns; ++column) {
    for (int row = 0; row < raster->rows; ++row) At(line.cells, row) = raster->height_m[CellAt(*raster, column, row)];
    FilterLine(&line, reach, better);
    for (int row = 0; row < raster->rows; ++row) raster->height_m[CellAt(*raster, column, row)] = At(line.cells, row);
  }
}

// What a triangle is at its edges, twice a cell: visit(column, row, z).
template <typename Visit>
void VisitEdges(const Triangle3& triangle, const GroundRaster& raster, const Visit& visit) {
  for (size_t i = 0; i < 3; ++i) {
    const Point3 &a = triangle[i], &b = triangle[(i + 1) % 3];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const int steps = std::max(1, static_cast<int>(std::ceil(2 * length / raster.cell_m)));
    for (int k = 0; k <= steps; ++k) {
      const double s = static_cast<double>(k) / steps;
      visit(ColumnAt(raster, a.x + s * (b.x - a.x)), RowAt(raster, a.y + s * (b.y - a.y)), a.z + s * (b.z - a.z));
    }
  }
}

// The columns that a triangle may have along y, and some more.
std::pair<int, int> ColumnsAlong(const Triangle3& triangle, double y, const GroundRaster& raster) {
  constexpr double kLevel_m = 1e-6;  // an edge that rises by less may be anywhere along its length
  double west = std::numeric_limits<double>::max(), east = -west;
  for (size_t i = 0; i < 3; ++i) {
    const Point3 &a = triangle[i], &b = triangle[(i + 1) % 3];
    const bool level = std::abs(b.y - a.y) < kLevel_m;
    if (level && std::abs(y - a.y) > 2 * kLevel_m) continue;
    if (y < std::min(a.y, b.y) - kLevel_m || y > std::max(a.y, b.y) + kLevel_m) continue;
    const double t = level ? 0 : std::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0);
    const double x = a.x + t * (b.x - a.x);
    west = std::min(west, level ? std::min(a.x, b.x) : x), east = std::max(east, level ? std::max(a.x, b.x) : x);
  }
  if (west > east) return {0, -1};
  return {std::max(ColumnAt(raster, west) - 1, 0), std::min(ColumnAt(raster, east) + 1, raster.columns - 1)};
}

// Likewise at the middles of the cells under it.
template <typename Visit>
void VisitArea(const Triangle3& triangle, const GroundRaster& raster, const Visit& visit) {
  const auto& [a, b, c] = triangle;
  const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  if (std::abs(area) < 1e-9) return;
  const int r0 = std::max(RowAt(raster, std::min({a.y, b.y, c.y})), 0);
  const int r1 = std::min(RowAt(raster, std::max({a.y, b.y, c.y})), raster.rows - 1);
  for (int row = r0; row <= r1; ++row) {
    const double y = raster.min_m.y + (row + 0.5) * raster.cell_m;
    const auto [c0, c1] = ColumnsAlong(triangle, y, raster);
    for (int column = c0; column <= c1; ++column) {
      const double x = raster.min_m.x + (column + 0.5) * raster.cell_m;
      const double wb = ((x - a.x) * (c.y - a.y) - (c.x - a.x) * (y - a.y)) / area;
      const double wc = ((b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y)) / area;
      if (wb < -1e-9 || wc < -1e-9 || wb + wc > 1 + 1e-9) continue;
      visit(column, row, a.z + wb * (b.z - a.z) + wc * (c.z - a.z));
    }
  }
}

}  // namespace

GroundRaster BlankRaster(Point2 min_m, Point2 max_m, double cell_m) {
  GroundRaster raster;
  const double width = max_m.x - min_m.x, depth = max_m.y - min_m.y;
  double cell = cell_m;
  while ((width / cell + 2) * (depth / cell + 2) > kMaxBaseCells) cell *= 2;
  raster.cell_m = static_cast<float>(cell);
  raster.min_m = {static_cast<float>(std::floor(min_m.x / cell) * cell),
                  static_cast<float>(std::floor(min_m.y / cell) * cell)};
  raster.columns = ColumnAt(raster, max_m.x) + 1;
  raster.rows = RowAt(raster, max_m.y) + 1;
  const size_t cells = static_cast<size_t>(raster.columns) * static_cast<size_t>(raster.rows);
  raster.height_m.assign(cells, kNoHeight);
  raster.kind.assign(cells, 0);
  return raster;
}

int ColumnAt(const GroundRaster& raster, double x) {
  return static_cast<int>(std::floor((x - raster.min_m.x) / raster.cell_m));
}
int RowAt(const GroundRaster& raster, double y) {
  return static_cast<int>(std::floor((y - raster.min_m.y) / raster.cell_m));
}

bool IsWall(const Triangle3& triangle) {
  const auto& [a, b, c] = triangle;
  const double x = (b.y - a.y) * (c.z - a.z) - (b.z - a.z) * (c.y - a.y);
  const double y = (b.z - a.z) * (c.x - a.x) - (b.x - a.x) * (c.z - a.z);
  const double z = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  return std::abs(z) < kMaxWallSlope * std::hypot(x, y, z);
}

void DrawEdges(const Triangle3& triangle, GroundRaster* raster) {
  VisitEdges(triangle, *raster, [&](int column, int row, double z) { LowerTo(column, row, z, raster); });
}

void DrawArea(const Triangle3& triangle, GroundRaster* raster) {
  VisitArea(triangle, *raster, [&](int column, int row, double z) { LowerTo(column, row, z, raster); });
}

void ForgetAt(const Triangle3& triangle, double within_m, float least_m, GroundRaster* raster) {
  const auto forget = [&](int column, int row, double z) {
    if (column < 0 || row < 0 || column >= raster->columns || row >= raster->rows) return;
    float& height = raster->height_m[CellAt(*raster, column, row)];
    if (height >= least_m && std::abs(height - z) <= within_m) height = kNoHeight;
  };
  VisitEdges(triangle, *raster, forget);
  VisitArea(triangle, *raster, forget);
}

void TakeLeast(int reach, GroundRaster* raster) {
  Filter(raster, reach, [](float a, float b) { return a < b; });
}
void TakeGreatest(int reach, GroundRaster* raster) {
  Filter(raster, reach, [](float a, float b) { return a > b; });
}

}  // namespace flaneur
