#include "pipeline/footprint/rasterize_ground.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "pipeline/footprint/base_ground.h"
#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/plan_raster.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

struct Extent {
  double min_x = std::numeric_limits<double>::max(), min_y = min_x, min_z = min_x;
  double max_x = -min_x, max_y = -min_x;
  void Add(const Point3& p) {
    min_x = std::min(min_x, p.x), max_x = std::max(max_x, p.x);
    min_y = std::min(min_y, p.y), max_y = std::max(max_y, p.y);
    min_z = std::min(min_z, p.z);
  }
};

Extent GroundExtent(const TownObjects& town) {
  Extent extent;
  for (const GroundPatch& patch : town.ground)
    for (const Triangle3& t : patch.triangles)
      for (const Point3& p : t) extent.Add(p);
  return extent;
}

Extent ObstacleExtent(const TownObjects& town) {
  Extent extent;
  for (const TownObject& object : town.obstacles) extent.Add(object.min_m), extent.Add(object.max_m);
  return extent;
}

Error LayOut(const Extent& extent, const GroundRasterOptions& options, GroundRaster* raster) {
  const double width = extent.max_x - extent.min_x, depth = extent.max_y - extent.min_y;
  if (!(width < kMaxGround_m) || !(depth < kMaxGround_m))
    return Fail("the town is " + std::to_string(std::max(width, depth) / 1000) +
                " km wide, more than 100 km; are its units metres? See the option for the scale");
  double cell = options.cell_m;
  while ((width / cell + 2) * (depth / cell + 2) > options.max_cells) cell *= 2;
  raster->min_m = {static_cast<float>(std::floor(extent.min_x / cell) * cell),
                   static_cast<float>(std::floor(extent.min_y / cell) * cell)};
  raster->cell_m = static_cast<float>(cell);
  raster->columns = static_cast<int>(std::ceil((extent.max_x - raster->min_m.x) / cell - 1e-6));
  raster->rows = static_cast<int>(std::ceil((extent.max_y - raster->min_m.y) / cell - 1e-6));
  raster->columns = std::max(raster->columns, 1);
  raster->rows = std::max(raster->rows, 1);
  const size_t cells = static_cast<size_t>(raster->columns) * static_cast<size_t>(raster->rows);
  raster->height_m.assign(cells, 0);
  raster->kind.assign(cells, static_cast<uint8_t>(GroundKind::kNone));
  return Ok();
}

int Column(const GroundRaster& raster, double x) {
  return static_cast<int>(std::floor((x - raster.min_m.x) / raster.cell_m));
}
int Row(const GroundRaster& raster, double y) {
  return static_cast<int>(std::floor((y - raster.min_m.y) / raster.cell_m));
}

void DrawTriangle(const Triangle3& t, GroundKind kind, GroundRaster* raster) {
  const auto [a, b, c] = t;
  const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  if (std::abs(area) < 1e-9) return;
  const int c0 = std::max(Column(*raster, std::min({a.x, b.x, c.x})), 0);
  const int c1 = std::min(Column(*raster, std::max({a.x, b.x, c.x})), raster->columns - 1);
  const int r0 = std::max(Row(*raster, std::min({a.y, b.y, c.y})), 0);
  const int r1 = std::min(Row(*raster, std::max({a.y, b.y, c.y})), raster->rows - 1);
  for (int row = r0; row <= r1; ++row) {
    for (int column = c0; column <= c1; ++column) {
      const double x = raster->min_m.x + (column + 0.5) * raster->cell_m;
      const double y = raster->min_m.y + (row + 0.5) * raster->cell_m;
      const double wb = ((x - a.x) * (c.y - a.y) - (c.x - a.x) * (y - a.y)) / area;
      const double wc = ((b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y)) / area;
      if (wb < -1e-9 || wc < -1e-9 || wb + wc > 1 + 1e-9) continue;
      const float z = static_cast<float>(a.z + wb * (b.z - a.z) + wc * (c.z - a.z));
      const size_t cell = RowMajor(row, raster->columns, column);
      const bool empty = raster->kind[cell] == 0;
      // Equal heights: the higher kind wins, so that the order of the patches does not matter.
      const bool above = z > raster->height_m[cell] ||
                         (z == raster->height_m[cell] && static_cast<uint8_t>(kind) > raster->kind[cell]);
      if (!empty && !above) continue;
      raster->height_m[cell] = z;
      raster->kind[cell] = static_cast<uint8_t>(kind);
    }
  }
}

void SmoothGaps(GroundRaster* raster) {
  const int columns = raster->columns, rows = raster->rows;
  const auto stride = static_cast<size_t>(columns);
  std::vector<float>& heights = raster->height_m;
  const auto smooth = [&](int row, int from, int to) {
    bool changed = false;
    for (int column = from; column < to; ++column) {
      const size_t i = RowMajor(row, columns, column);
      if (raster->kind[i]) continue;
      const float before = heights[i];
      const float west = column > 0 ? heights[i - 1] : before;
      const float east = column + 1 < columns ? heights[i + 1] : before;
      const float south = row > 0 ? heights[i - stride] : before;
      const float north = row + 1 < rows ? heights[i + stride] : before;
      heights[i] = (west + east + south + north) / 4;
      changed |= heights[i] != before;
    }
    return changed;
  };
  // Cells side by side, of which nothing need be looked at while nothing in them and beside them has changed.
  constexpr int kStretch = 32;
  const int stretches = (columns + kStretch - 1) / kStretch;
  std::vector<int> changed_in(static_cast<size_t>(stretches) * static_cast<size_t>(rows), 0);  // the last round
  const auto is_restless = [&](int row, int k, int round) {
    const auto changed = [&](int r, int s) {
      return r >= 0 && r < rows && s >= 0 && s < stretches && changed_in[RowMajor(r, stretches, s)] >= round - 1;
    };
    return changed(row, k) || changed(row, k - 1) || changed(row, k + 1) || changed(row - 1, k) || changed(row + 1, k);
  };
  for (int round = 1; round <= kSmoothingRounds; ++round)
    for (int row = 0; row < rows; ++row)
      for (int k = 0; k < stretches; ++k)
        if (is_restless(row, k, round) && smooth(row, k * kStretch, std::min((k + 1) * kStretch, columns)))
          changed_in[RowMajor(row, stretches, k)] = round;
}

// How many cells after this one in a direction there is ground, up to `most`; 0: none.
int GroundAfter(const GroundRaster& raster, int column, int row, int dx, int dy, int most) {
  for (int k = 1; k <= most; ++k) {
    const int c = column + k * dx, r = row + k * dy;
    if (c < 0 || r < 0 || c >= raster.columns || r >= raster.rows) return 0;
    if (raster.kind[CellAt(raster, c, r)]) return k;
  }
  return 0;
}

// People step over cracks between pieces of ground: the tiles of a square need not meet.
void StepOverCracks(GroundRaster* raster) {
  const int most = static_cast<int>(kMaxCrack_m / static_cast<double>(raster->cell_m) + 1e-6);
  const GroundRaster drawn = *raster;
  for (int row = 0; row < drawn.rows; ++row) {
    for (int column = 0; column < drawn.columns; ++column) {
      const size_t cell = CellAt(drawn, column, row);
      if (drawn.kind[cell]) continue;
      for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(0, 1)}) {
        const int after = GroundAfter(drawn, column, row, dx, dy, most);
        const int before = after == 0 ? 0 : GroundAfter(drawn, column, row, -dx, -dy, most);
        if (before == 0 || after + before - 1 > most) continue;
        const size_t a = CellAt(drawn, column + after * dx, row + after * dy);
        const size_t b = CellAt(drawn, column - before * dx, row - before * dy);
        if (std::abs(drawn.height_m[a] - drawn.height_m[b]) > kMaxCrackStep_m) continue;
        const float share = static_cast<float>(before) / static_cast<float>(before + after);
        raster->height_m[cell] = drawn.height_m[b] + share * (drawn.height_m[a] - drawn.height_m[b]);
        raster->kind[cell] = std::max(drawn.kind[a], drawn.kind[b]);
        break;
      }
    }
  }
}

// The decks of bridges are ground as far as one gets on them from the ground, in low steps.
void DrawDecks(const TownObjects& town, GroundRaster* raster) {
  GroundRaster deck = *raster;  // upside down: its drawing keeps the lowest
  std::fill(deck.height_m.begin(), deck.height_m.end(), kNoHeight);
  for (const TownObject& object : town.obstacles) {
    if (!object.is_bridge) continue;
    for (Triangle3 t : object.triangles) {
      if (IsWall(t)) continue;
      for (Point3& p : t) p.z = -p.z;
      DrawArea(t, &deck);
    }
  }
  const auto leads_on = [](float from, float to) { return std::abs(from - to) <= kMaxDeckSlope_m; };
  std::vector<std::pair<int, int>> reached;
  std::vector<bool> done(deck.height_m.size(), false);
  const auto reach = [&](int column, int row, auto test) {
    if (column < 0 || row < 0 || column >= deck.columns || row >= deck.rows) return;
    const size_t cell = CellAt(deck, column, row);
    if (done[cell] || deck.height_m[cell] == kNoHeight || !test(-deck.height_m[cell])) return;
    done[cell] = true;
    reached.emplace_back(column, row);
  };
  for (int row = 0; row < deck.rows; ++row)
    for (int column = 0; column < deck.columns; ++column) {
      const size_t cell = CellAt(deck, column, row);
      if (!raster->kind[cell]) continue;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          reach(column + dx, row + dy, [&](float z) { return leads_on(raster->height_m[cell], z); });
    }
  for (size_t k = 0; k < reached.size(); ++k) {
    const auto [column, row] = reached[k];
    const float here = -deck.height_m[CellAt(deck, column, row)];
    for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)})
      reach(column + dx, row + dy, [&](float z) { return leads_on(here, z); });
  }
  for (size_t i = 0; i < done.size(); ++i)
    if (done[i]) raster->height_m[i] = -deck.height_m[i], raster->kind[i] = static_cast<uint8_t>(GroundKind::kPavement);
}

// What the feet of buildings, or where there are none of all things, tell of the ground between them.
void DrawBases(const TownObjects& town, GroundRaster* raster) {
  const auto is_house = [](const TownObject& o) {
    return o.kind == ObstacleKind::kBuilding || o.kind == ObstacleKind::kWall;
  };
  const bool any_house = std::any_of(town.obstacles.begin(), town.obstacles.end(), is_house);
  for (const TownObject& object : town.obstacles) {
    if (any_house && !is_house(object)) continue;
    const GroundRaster base = BaseOf(object);
    for (int row = 0; row < base.rows; ++row) {
      for (int column = 0; column < base.columns; ++column) {
        const size_t i = RowMajor(row, base.columns, column);
        if (!base.kind[i]) continue;
        const int c = Column(*raster, base.min_m.x + (column + 0.5) * base.cell_m);
        const int r = Row(*raster, base.min_m.y + (row + 0.5) * base.cell_m);
        if (c < 0 || r < 0 || c >= raster->columns || r >= raster->rows) continue;
        const size_t cell = RowMajor(r, raster->columns, c);
        raster->height_m[cell] =
            raster->kind[cell] ? std::min(raster->height_m[cell], base.height_m[i]) : base.height_m[i];
        raster->kind[cell] = static_cast<uint8_t>(GroundKind::kSquare);
      }
    }
  }
  FillGaps(raster);
  SmoothGaps(raster);
  std::fill(raster->kind.begin(), raster->kind.end(), static_cast<uint8_t>(GroundKind::kSquare));
}

}  // namespace

// Two sweeps each way carry every empty cell the height of a near ground cell.
void FillGaps(GroundRaster* raster) {
  const int columns = raster->columns, rows = raster->rows;
  const auto at = [&](int column, int row) { return RowMajor(row, columns, column); };
  std::vector<float> distance(raster->kind.size(), std::numeric_limits<float>::max());
  for (size_t i = 0; i < distance.size(); ++i)
    if (raster->kind[i]) distance[i] = 0;
  const auto take = [&](int column, int row, int from_column, int from_row, float step) {
    if (from_column < 0 || from_column >= columns || from_row < 0 || from_row >= rows) return;
    const size_t to = at(column, row), from = at(from_column, from_row);
    if (distance[from] + step >= distance[to]) return;
    distance[to] = distance[from] + step;
    raster->height_m[to] = raster->height_m[from];
  };
  const float diagonal = 1.41421356f;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      take(column, row, column - 1, row, 1), take(column, row, column, row - 1, 1);
      take(column, row, column - 1, row - 1, diagonal), take(column, row, column + 1, row - 1, diagonal);
    }
    for (int column = columns - 1; column >= 0; --column) take(column, row, column + 1, row, 1);
  }
  for (int row = rows - 1; row >= 0; --row) {
    for (int column = columns - 1; column >= 0; --column) {
      take(column, row, column + 1, row, 1), take(column, row, column, row + 1, 1);
      take(column, row, column + 1, row + 1, diagonal), take(column, row, column - 1, row + 1, diagonal);
    }
    for (int column = 0; column < columns; ++column) take(column, row, column - 1, row, 1);
  }
}

Error RasterizeGround(const TownObjects& town, const GroundRasterOptions& options, GroundRaster* raster) {
  if (!(options.cell_m > 0) || options.max_cells <= 0)
    return Fail("the ground's cell size and the most cells must be greater than zero");
  Extent extent = GroundExtent(town);
  const bool bare = extent.min_x > extent.max_x;
  if (bare) {
    extent = ObstacleExtent(town);
    if (extent.min_x > extent.max_x) return Fail("the town has neither ground nor obstacles");
    extent.min_x -= options.bare_margin_m, extent.max_x += options.bare_margin_m;
    extent.min_y -= options.bare_margin_m, extent.max_y += options.bare_margin_m;
  }
  if (Error error = LayOut(extent, options, raster)) return error;
  if (bare) DrawBases(town, raster);
  for (const GroundPatch& patch : town.ground)
    for (const Triangle3& t : patch.triangles) DrawTriangle(t, patch.kind, raster);
  StepOverCracks(raster);
  if (options.with_decks && !bare && HasBridge(town)) DrawDecks(town, raster);
  return Ok();
}

Error RasterizeGround(const Scene& scene, const GroundRasterOptions& options, GroundRaster* raster) {
  if (!(options.scale > 0)) return Fail("the scale must be greater than zero");
  return RasterizeGround(SortTown(scene, options.scale), options, raster);
}

LocalGround::LocalGround(const GroundRaster& raster, Gaps gaps) : raster_(raster) {
  FillGaps(&raster_);
  if (gaps == Gaps::kSmooth) SmoothGaps(&raster_);
  const auto [low, high] = std::minmax_element(raster_.height_m.begin(), raster_.height_m.end());
  min_height_ = *low, max_height_ = *high;
}

double LocalGround::Height(double x, double y) const {
  const double u = std::clamp((x - raster_.min_m.x) / raster_.cell_m - 0.5, 0.0, raster_.columns - 1.0);
  const double v = std::clamp((y - raster_.min_m.y) / raster_.cell_m - 0.5, 0.0, raster_.rows - 1.0);
  const int c0 = static_cast<int>(u), r0 = static_cast<int>(v);
  const int c1 = std::min(c0 + 1, raster_.columns - 1), r1 = std::min(r0 + 1, raster_.rows - 1);
  const auto at = [&](int column, int row) -> double {
    return raster_.height_m[RowMajor(row, raster_.columns, column)];
  };
  const double fu = u - c0, fv = v - r0;
  const double nearest = at(fu < 0.5 ? c0 : c1, fv < 0.5 ? r0 : r1);
  const auto near = [&](int column, int row) {
    const double height = at(column, row);
    return std::abs(height - nearest) > kMaxSlopeStep_m ? nearest : height;
  };
  return (near(c0, r0) * (1 - fu) + near(c1, r0) * fu) * (1 - fv) + (near(c0, r1) * (1 - fu) + near(c1, r1) * fu) * fv;
}

std::pair<double, double> LocalGround::Range(Point2 min, Point2 max) const {
  const auto cell = [&](double v, double from, int count, int beyond) {
    const double at = std::clamp((v - from) / raster_.cell_m - 0.5, 0.0, count - 1.0);
    return std::clamp(static_cast<int>(at) + beyond, 0, count - 1);
  };
  const int c0 = cell(min.x, raster_.min_m.x, raster_.columns, 0),
            c1 = cell(max.x, raster_.min_m.x, raster_.columns, 1);
  const int r0 = cell(min.y, raster_.min_m.y, raster_.rows, 0), r1 = cell(max.y, raster_.min_m.y, raster_.rows, 1);
  float low = std::numeric_limits<float>::max(), high = -low;
  for (int row = r0; row <= r1; ++row) {
    for (int column = c0; column <= c1; ++column) {
      const float height = raster_.height_m[RowMajor(row, raster_.columns, column)];
      low = std::min(low, height), high = std::max(high, height);
    }
  }
  return {low, high};
}

}  // namespace flaneur
