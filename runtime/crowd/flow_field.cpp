#include "runtime/crowd/flow_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "runtime/crowd/constants.h"
#include "runtime/crowd/fast_math.h"

namespace flaneur {
namespace {

constexpr float kExactAround_m = 3;  // straight lines instead of marching: marching is least exact near its source
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr uint8_t kNoWay = 255;

constexpr int64_t kMarchCost_cells = 3;  // the march takes so many times as long for a cell as describing its direction

using Entry = std::pair<float, int>;  // ties by cell: the same everywhere

// The cheaper of two opposite neighbours and where it lies (-1, +1), infinity if neither has a value.
struct Upwind {
  float value = kInfinity;
  int side = 0;
};

Upwind Cheaper(const std::vector<float>& t, int cell, int stride, bool has_low, bool has_high) {
  Upwind u;
  if (has_low && t[static_cast<size_t>(cell - stride)] < u.value) u = {t[static_cast<size_t>(cell - stride)], -1};
  if (has_high && t[static_cast<size_t>(cell + stride)] < u.value) u = {t[static_cast<size_t>(cell + stride)], 1};
  return u;
}

struct Around {
  Upwind x, y;
};

Around Look(const Walkable& w, const std::vector<float>& t, int cell) {
  const int x = cell % w.columns, y = cell / w.columns;
  Around a{Cheaper(t, cell, 1, x > 0, x + 1 < w.columns), Cheaper(t, cell, w.columns, y > 0, y + 1 < w.rows)};
  // Between two free cells an obstacle's corner may stick out: then only the cheaper of them leads on.
  if (a.x.side != 0 && a.y.side != 0 && w.cost[static_cast<size_t>(cell + a.x.side + a.y.side * w.columns)] <= 0) {
    (a.x.value <= a.y.value ? a.y : a.x) = Upwind{};
  }
  return a;
}

// First-order upwind solution of |grad T| = cost at a cell.
float Solve(const Around& a, float cost_of_cell) {
  const float low = std::min(a.x.value, a.y.value), high = std::max(a.x.value, a.y.value);
  if (high - low >= cost_of_cell) return low + cost_of_cell;
  const float sum = low + high;
  return 0.5f * (sum + std::sqrt(2 * cost_of_cell * cost_of_cell - (high - low) * (high - low)));
}

void Push(float value, int cell, FieldBuild* build) {
  build->open.push_back({value, cell});
  std::push_heap(build->open.begin(), build->open.end(), std::greater<>());
}

Entry Pop(FieldBuild* build) {
  std::pop_heap(build->open.begin(), build->open.end(), std::greater<>());
  const Entry least = build->open.back();
  build->open.pop_back();
  return least;
}

void SeedAroundGoal(const Walkable& w, int start, FieldBuild* build) {
  const FlowField& field = build->field;
  const int reach = static_cast<int>(kExactAround_m / w.cell_m);
  const int cx = start % w.columns, cy = start / w.columns;
  for (int y = std::max(0, cy - reach); y <= std::min(w.rows - 1, cy + reach); ++y) {
    for (int x = std::max(0, cx - reach); x <= std::min(w.columns - 1, cx + reach); ++x) {
      const int cell = y * w.columns + x;
      const Vec2 center = CellCenter(w, cell);
      const float distance_m = Length(center - field.goal);
      if (w.cost[static_cast<size_t>(cell)] <= 0 || distance_m > kExactAround_m) continue;
      if (cell != start && !(StraightWay(w, center, field.goal) && StraightWay(w, field.goal, center))) continue;
      build->distance[static_cast<size_t>(cell)] = distance_m * CostOfGround(w, cell);
      Push(build->distance[static_cast<size_t>(cell)], cell, build);
    }
  }
}

void Begin(const Walkable& w, FieldBuild* build) {
  FlowField& field = build->field;
  build->distance.assign(w.cost.size(), kInfinity);
  const size_t squares = static_cast<size_t>((w.columns + 63) / 64) * static_cast<size_t>((w.rows + 63) / 64);
  field.tiles.resize(64 * squares);
  for (DirectionTile& tile : field.tiles) std::fill(std::begin(tile.direction), std::end(tile.direction), kNoWay);
  if (const int start = FreeCellFor(w, field.goal); start >= 0) SeedAroundGoal(w, start, build);
  build->described = 0;
}

// Returns how many more cells the slice may go over.
int64_t March(const Walkable& w, int64_t cells, FieldBuild* build) {
  std::vector<float>& t = build->distance;
  while (!build->open.empty() && cells > 0) {
    const auto [value, cell] = Pop(build);
    if (value > t[static_cast<size_t>(cell)]) continue;
    cells -= kMarchCost_cells;
    const int x = cell % w.columns, y = cell / w.columns;
    const int next[4] = {x > 0 ? cell - 1 : -1, x + 1 < w.columns ? cell + 1 : -1, y > 0 ? cell - w.columns : -1,
                         y + 1 < w.rows ? cell + w.columns : -1};
    for (int n : next) {
      if (n < 0 || w.cost[static_cast<size_t>(n)] <= 0 || t[static_cast<size_t>(n)] <= value) continue;
      const float better = Solve(Look(w, t, n), CostOfGround(w, n) * w.cell_m);
      if (better >= t[static_cast<size_t>(n)]) continue;
      t[static_cast<size_t>(n)] = better;
      Push(better, n, build);
    }
  }
  return cells;
}

uint8_t Descent(const Walkable& w, const FieldBuild& build, int cell) {
  const FlowField& field = build.field;
  const float t = build.distance[static_cast<size_t>(cell)];
  if (!std::isfinite(t)) return kNoWay;
  Vec2 way = field.goal - CellCenter(w, cell);
  if (Length(way) > kExactAround_m || !StraightWay(w, CellCenter(w, cell), field.goal)) {
    const Around a = Look(w, build.distance, cell);
    way = {a.x.value < t ? static_cast<float>(a.x.side) * (t - a.x.value) : 0.0f,
           a.y.value < t ? static_cast<float>(a.y.side) * (t - a.y.value) : 0.0f};
  }
  const float turn = AngleOf(way) / (2 * kPi);
  return static_cast<uint8_t>((Rounded(turn * 255.0f) + 255) % 255);
}

std::array<Vec2, 256> MakeDirections() {
  std::array<Vec2, 256> table{};
  for (size_t k = 0; k < 255; ++k) {
    const double angle = 2 * 3.14159265358979323846 * static_cast<double>(k) / 255;
    table[k] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
  }
  return table;  // the last entry, no way, is zero
}

const std::array<Vec2, 256> kDirections = MakeDirections();

// The two cells of a row, or of a column, that a place lies between, and their shares; one that is outside has none.
struct Between {
  int low = 0, high = 0;
  float low_share = 0, high_share = 0;
};

Between BetweenCells(float at, int count) {
  const int low = static_cast<int>(std::floor(at)), high = low + 1;
  const float rest = at - static_cast<float>(low);
  if (low >= 0 && high < count) return {low, high, 1 - rest, rest};
  return {std::clamp(low, 0, count - 1), std::clamp(high, 0, count - 1), low >= 0 && low < count ? 1 - rest : 0.0f,
          high >= 0 && high < count ? rest : 0.0f};
}

}  // namespace

float CostOfGround(const Walkable& w, int cell) {
  return w.cost[static_cast<size_t>(cell)] * (1 + kSlopeCost * SlopeOf(w, cell));
}

FlowField BuildFlowField(const Walkable& w, Vec2 goal) {
  FieldBuild build{{goal, {}}, {}, {}};
  while (!BuildFurther(w, std::numeric_limits<int64_t>::max(), &build)) {}
  return std::move(build.field);
}

int64_t CellsToGoOver(const Walkable& w) {
  return (1 + kMarchCost_cells) * std::count_if(w.cost.begin(), w.cost.end(), [](float cost) { return cost > 0; });
}

bool BuildFurther(const Walkable& w, int64_t cells, FieldBuild* build) {
  if (build->described < 0) Begin(w, build);
  cells = March(w, cells, build);
  if (!build->open.empty()) return false;
  FlowField& field = build->field;
  for (int& cell = build->described; cell < static_cast<int>(w.cost.size()) && cells > 0; ++cell) {
    if (w.cost[static_cast<size_t>(cell)] <= 0) continue;  // nobody can stand there, and no way is what it says already
    --cells;
    const size_t k = DirectionIndex(w, cell % w.columns, cell / w.columns);
    field.tiles[k >> 6].direction[k & 63] = Descent(w, *build, cell);
  }
  return build->described == static_cast<int>(w.cost.size());
}

bool Reachable(const Walkable& w, const FlowField& field, Vec2 from) {
  const int a = FreeCellFor(w, from);
  const int b = FreeCellFor(w, field.goal);
  return a >= 0 && b >= 0 && w.component[static_cast<size_t>(a)] == w.component[static_cast<size_t>(b)];
}

Vec2 WayAt(const Walkable& w, const FlowField& field, Vec2 p) {
  // Bilinear over the four nearest cells; those without a way, or outside, add nothing.
  const float fx = (p.x - w.min_m.x) / w.cell_m - 0.5f, fy = (p.y - w.min_m.y) / w.cell_m - 0.5f;
  const Between x = BetweenCells(fx, w.columns), y = BetweenCells(fy, w.rows);
  const size_t low_row = DirectionRow(w, y.low), high_row = DirectionRow(w, y.high);
  const size_t low_column = DirectionColumn(x.low), high_column = DirectionColumn(x.high);
  const auto way = [&](size_t index) { return kDirections[DirectionAt(field, index)]; };
  const Vec2 sum = way(low_row + low_column) * (x.low_share * y.low_share) +
                   way(low_row + high_column) * (x.high_share * y.low_share) +
                   way(high_row + low_column) * (x.low_share * y.high_share) +
                   way(high_row + high_column) * (x.high_share * y.high_share);
  if (Dot(sum, sum) > 0.01f) return Unit(sum);
  const int cell = NearestFreeCell(w, p, kPlaceReach_m);  // squeezed against a wall: back to where ways are known
  if (cell < 0) return {};
  const uint8_t direction = DirectionAt(field, DirectionIndex(w, cell % w.columns, cell / w.columns));
  if (direction == kNoWay) return {};
  const Vec2 there = kDirections[direction];
  return Unit(Unit(CellCenter(w, cell) - p) + there);
}

Vec2 RoughWayAt(const Walkable& w, const FlowField& field, Vec2 p) {
  const GridPlace at = PlaceAt(w, p);
  const uint8_t direction = at.x >= 0 ? DirectionAt(field, DirectionIndex(w, at.x, at.y)) : kNoWay;
  return direction != kNoWay ? kDirections[direction] : WayAt(w, field, p);
}

bool StraightWay(const Walkable& w, Vec2 p, Vec2 q) {
  const int first = CellAt(w, p);
  if (first < 0) return false;
  const float max_cost =
      w.cost[static_cast<size_t>(first)] > 0 ? CostOfGround(w, first) * kNearWallCost * 1.01f : kGroundCost[1];
  const Vec2 way = q - p;
  const float way_m = Length(way), longer_m = std::max(std::abs(way.x), std::abs(way.y));
  const float least = 0.5f * w.cell_m / std::max(way_m, 1e-6f), cells = w.cell_m * 0.99f / std::max(longer_m, 1e-6f);
  bool known = true;  // leaps over what costs the same, and looks at the cost only where it may be another
  for (float t = 0; t < 1;) {
    const int cell = CellAt(w, p + way * t);
    if (cell < 0) return false;
    if (!known) {
      const float cost = CostOfGround(w, cell);
      if (cost <= 0 || cost > max_cost) return false;
    }
    const int same = w.cells[static_cast<size_t>(cell)].same;
    known = same > 0;
    t += known ? static_cast<float>(same) * cells : least;
  }
  return true;
}

}  // namespace flaneur
