#include "runtime/crowd/walkable.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/constants.h"
#include "runtime/crowd/fast_math.h"
#include "runtime/crowd/walls.h"

namespace flaneur {
namespace {

// Beyond touching: how far a person steps or feels a wall at most.
constexpr float kReachBeyondRadius_m = 0.6f;
constexpr float kMaxSlope = 255 * Walkable::kSlopeUnit;
constexpr int kMaxUniformRadius_cells = 200;

bool InsideRing(Vec2 p, const std::vector<Vec2>& ring) {
  bool inside = false;
  for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Vec2 a = ring[i], b = ring[j];
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) inside = !inside;
  }
  return inside;
}

bool InsidePolygon(Vec2 p, const PolygonObstacle& polygon) {
  if (!InsideRing(p, polygon.outer)) return false;
  for (const auto& hole : polygon.holes) {
    if (InsideRing(p, hole)) return false;
  }
  return true;
}

Walkable::Box BoxOf(const std::vector<Vec2>& ring) {
  Walkable::Box box{ring.front(), ring.front()};
  for (const Vec2 p : ring) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
  }
  return box;
}

void AddEdges(const std::vector<Vec2>& ring, std::vector<Walkable::Edge>* edges) {
  for (size_t i = 0; i < ring.size(); ++i) edges->push_back({ring[i], ring[(i + 1) % ring.size()]});
}

// Of the cell at v; the first or last one beyond them.
int IndexAlong(float v, float origin, float cell_m, int count) {
  return static_cast<int>(std::clamp(std::floor((v - origin) / cell_m), 0.0f, static_cast<float>(count - 1)));
}

// Calls visit(cell) for the cells that the box, grown by reach_m, touches.
template <typename Visit>
void VisitCells(const Walkable& w, Vec2 low, Vec2 high, float reach_m, Visit visit) {
  const int x0 = IndexAlong(low.x - reach_m, w.min_m.x, w.cell_m, w.columns),
            x1 = IndexAlong(high.x + reach_m, w.min_m.x, w.cell_m, w.columns);
  const int y0 = IndexAlong(low.y - reach_m, w.min_m.y, w.cell_m, w.rows),
            y1 = IndexAlong(high.y + reach_m, w.min_m.y, w.cell_m, w.rows);
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) visit(y * w.columns + x);
  }
}

int RowAt(const Walkable& w, float y) {
  return static_cast<int>(std::clamp((y - w.min_m.y) / w.cell_m, -1.0f, static_cast<float>(w.rows)));
}

bool EdgeNearCell(const Walkable& w, const Walkable::Edge& e, int cell, float reach_m) {
  const Vec2 c = CellCenter(w, cell);
  return Length(NearestOnSegment(c, e.a, e.b) - c) <= reach_m + w.cell_m * 0.71f;
}

// Calls visit(cell) for the cells that VisitCells finds in the box of an edge, but row by row only for those about the
// part of the edge there: long edges lead through few of their box's cells.
template <typename Visit>
void VisitCellsAlong(const Walkable& w, const Walkable::Edge& e, float reach_m, Visit visit) {
  const Vec2 low = e.a.y <= e.b.y ? e.a : e.b, high = e.a.y <= e.b.y ? e.b : e.a;
  const float left_m = std::min(low.x, high.x), right_m = std::max(low.x, high.x), rise_m = high.y - low.y;
  const float around_m = reach_m + w.cell_m;
  const auto x_at = [&](float y) {
    return rise_m > 0 ? low.x + std::clamp((y - low.y) / rise_m, 0.0f, 1.0f) * (high.x - low.x) : low.x;
  };
  const int first = IndexAlong(low.y - reach_m, w.min_m.y, w.cell_m, w.rows);
  const int last = IndexAlong(high.y + reach_m, w.min_m.y, w.cell_m, w.rows);
  for (int row = first; row <= last; ++row) {
    const float y = CellCenter(w, row * w.columns).y;
    const float p = x_at(y - around_m), q = rise_m > 0 ? x_at(y + around_m) : high.x;
    const float from_m = std::max(std::min(p, q) - around_m, left_m - reach_m);
    const float to_m = std::min(std::max(p, q) + around_m, right_m + reach_m);
    const int end = IndexAlong(to_m, w.min_m.x, w.cell_m, w.columns);
    for (int x = IndexAlong(from_m, w.min_m.x, w.cell_m, w.columns); x <= end; ++x) visit(row * w.columns + x);
  }
}

// An item that `count` cells of a row share.
struct InCells {
  int cell = 0, count = 0, item = 0;
};

void AddCell(int cell, int item, std::vector<InCells>* all) {
  if (!all->empty() && all->back().item == item && all->back().cell + all->back().count == cell) ++all->back().count;
  else all->push_back({cell, 1, item});
}

// Turns them into ranges by cell, each in the order given.
void Bucket(int cells, const std::vector<InCells>& all, std::vector<int>* start, std::vector<int>* items) {
  start->assign(static_cast<size_t>(cells) + 1, 0);
  for (const InCells& in : all) {
    for (int k = 1; k <= in.count; ++k) ++(*start)[static_cast<size_t>(in.cell + k)];
  }
  for (size_t i = 1; i < start->size(); ++i) (*start)[i] += (*start)[i - 1];
  items->resize(static_cast<size_t>(start->back()));
  std::vector<int> fill(start->begin(), start->end() - 1);
  for (const InCells& in : all) {
    for (int k = 0; k < in.count; ++k)
      (*items)[static_cast<size_t>(fill[static_cast<size_t>(in.cell + k)]++)] = in.item;
  }
}

void BucketObstacles(float reach_m, Walkable* w) {
  const int cells = w->columns * w->rows;
  std::vector<InCells> all;
  for (size_t e = 0; e < w->edges.size(); ++e) {
    const auto& edge = w->edges[e];
    VisitCellsAlong(*w, edge, reach_m, [&](int cell) {
      if (EdgeNearCell(*w, edge, cell, reach_m)) AddCell(cell, static_cast<int>(e), &all);
    });
  }
  Bucket(cells, all, &w->wall_start, &w->wall_edges);
  all.clear();
  for (size_t c = 0; c < w->circles.size(); ++c) {
    const Vec2 r{w->circles[c].radius_m, w->circles[c].radius_m};
    VisitCells(*w, w->circles[c].center - r, w->circles[c].center + r, reach_m,
               [&](int cell) { AddCell(cell, static_cast<int>(c), &all); });
  }
  Bucket(cells, all, &w->circle_start, &w->wall_circles);
}

// Of a ring: where its edges cross the middle of a row of cells, as InsideRing has it.
struct RowCrossing {
  int row = 0;
  float x = 0;
};

// By row and from left to right.
void FindCrossings(const Walkable& w, const std::vector<Vec2>& ring, std::vector<RowCrossing>* crossings) {
  crossings->clear();
  for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Vec2 a = ring[i], b = ring[j];
    const int first = std::max(0, RowAt(w, std::min(a.y, b.y)) - 1);
    const int last = std::min(w.rows - 1, RowAt(w, std::max(a.y, b.y)) + 1);
    for (int row = first; row <= last; ++row) {
      const float y = CellCenter(w, row * w.columns).y;
      if ((a.y > y) != (b.y > y)) crossings->push_back({row, (b.x - a.x) * (y - a.y) / (b.y - a.y) + a.x});
    }
  }
  std::sort(crossings->begin(), crossings->end(),
            [](const RowCrossing& p, const RowCrossing& q) { return p.row != q.row ? p.row < q.row : p.x < q.x; });
}

// Columns whose middles lie left of x.
int ColumnsBefore(const Walkable& w, int row, float x) {
  const float guess = std::clamp((x - w.min_m.x) / w.cell_m + 0.5f, 0.0f, static_cast<float>(w.columns));
  int column = static_cast<int>(guess);
  const auto is_before = [&](int c) { return CellCenter(w, row * w.columns + c).x < x; };
  while (column > 0 && !is_before(column - 1)) --column;
  while (column < w.columns && is_before(column)) ++column;
  return column;
}

// Calls visit(cell) for every cell whose middle InsideRing finds inside.
template <typename Visit>
void VisitInside(const Walkable& w, const std::vector<Vec2>& ring, std::vector<RowCrossing>* crossings, Visit visit) {
  FindCrossings(w, ring, crossings);
  for (size_t k = 0; k + 1 < crossings->size(); k += 2) {  // a ring crosses a line an even number of times
    const RowCrossing &in = (*crossings)[k], &out = (*crossings)[k + 1];
    const int end = ColumnsBefore(w, in.row, out.x);
    for (int column = ColumnsBefore(w, in.row, in.x); column < end; ++column) visit(in.row * w.columns + column);
  }
}

// Marks what lies inside polygons. Rings are gone along once, not once a cell.
std::vector<char> Covered(const Walkable& w) {
  constexpr char kCovered = 1, kHere = 2, kHole = 4;
  std::vector<char> covered(w.cost.size(), 0);
  std::vector<RowCrossing> crossings;
  std::vector<int> here;
  for (const PolygonObstacle& polygon : w.polygons) {
    here.clear();
    VisitInside(w, polygon.outer, &crossings, [&](int cell) {
      covered[static_cast<size_t>(cell)] |= kHere;
      here.push_back(cell);
    });
    for (const auto& hole : polygon.holes) {
      VisitInside(w, hole, &crossings, [&](int cell) {
        if (covered[static_cast<size_t>(cell)] & kHere) covered[static_cast<size_t>(cell)] |= kHole;
      });
    }
    for (const int cell : here) {
      char& c = covered[static_cast<size_t>(cell)];
      c = static_cast<char>((c & kCovered) | (c & kHole ? 0 : kCovered));
    }
  }
  return covered;
}

int GroundCell(const GroundRaster& g, Vec2 p) {
  const int x = static_cast<int>(std::floor((p.x - g.min_m.x) / g.cell_m));
  const int y = static_cast<int>(std::floor((p.y - g.min_m.y) / g.cell_m));
  return x < 0 || y < 0 || x >= g.columns || y >= g.rows ? -1 : y * g.columns + x;
}

// From the heights a metre around.
float SlopeAt(const Walkable& w, Vec2 p) {
  constexpr float kAround_m = 0.5f;
  const float dx = HeightAt(w, p + Vec2{kAround_m, 0}) - HeightAt(w, p - Vec2{kAround_m, 0});
  const float dy = HeightAt(w, p + Vec2{0, kAround_m}) - HeightAt(w, p - Vec2{0, kAround_m});
  const float slope = std::sqrt(dx * dx + dy * dy) / (2 * kAround_m);
  return slope > kMaxSlope ? 0.0f : slope;  // a step between two levels of ground, not a slope
}

// A box as wide as the disc that density is measured in, by running sums along rows and columns.
void MeasureOpenShares(const std::vector<char>& covered, Walkable* w) {
  const int columns = w->columns, rows = w->rows;
  const int reach = std::max(1, static_cast<int>(0.886f * kDensityRadius_m / w->cell_m));  // a square of the same area
  std::vector<int> sum((static_cast<size_t>(columns) + 1) * (static_cast<size_t>(rows) + 1), 0);
  const auto at = [&](int x, int y) -> int& {
    return sum[static_cast<size_t>(y) * (static_cast<size_t>(columns) + 1) + static_cast<size_t>(x)];
  };
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const int cell = y * columns + x;
      const bool open = !covered[static_cast<size_t>(cell)] && OnGround(*w, CellCenter(*w, cell));
      at(x + 1, y + 1) = at(x, y + 1) + at(x + 1, y) - at(x, y) + (open ? 1 : 0);
    }
  }
  const int all = (2 * reach + 1) * (2 * reach + 1);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const int x0 = std::max(0, x - reach), x1 = std::min(columns, x + reach + 1);
      const int y0 = std::max(0, y - reach), y1 = std::min(rows, y + reach + 1);
      w->cells[static_cast<size_t>(y * columns + x)].open =
          static_cast<uint8_t>((at(x1, y1) - at(x0, y1) - at(x1, y0) + at(x0, y0)) * 255 / all);
    }
  }
}

void NumberComponents(Walkable* w) {
  w->component.assign(w->cost.size(), -1);
  std::vector<int> stack;
  int count = 0;
  for (int seed = 0; seed < static_cast<int>(w->cost.size()); ++seed) {
    if (w->cost[static_cast<size_t>(seed)] <= 0 || w->component[static_cast<size_t>(seed)] >= 0) continue;
    stack.assign(1, seed);
    w->component[static_cast<size_t>(seed)] = count;
    while (!stack.empty()) {
      const int cell = stack.back();
      stack.pop_back();
      const int x = cell % w->columns, y = cell / w->columns;
      const int next[4] = {x > 0 ? cell - 1 : -1, x + 1 < w->columns ? cell + 1 : -1, y > 0 ? cell - w->columns : -1,
                           y + 1 < w->rows ? cell + w->columns : -1};
      for (int n : next) {
        if (n < 0 || w->cost[static_cast<size_t>(n)] <= 0 || w->component[static_cast<size_t>(n)] >= 0) continue;
        w->component[static_cast<size_t>(n)] = count;
        stack.push_back(n);
      }
    }
    ++count;
  }
}

// How many cells of ground rasters are no ground, by sums over rectangles from the raster's corner.
struct Holes {
  const GroundRaster& g;
  std::vector<int> sum;

  explicit Holes(const GroundRaster& ground)
      : g(ground), sum((static_cast<size_t>(g.columns) + 1) * (static_cast<size_t>(g.rows) + 1), 0) {
    for (int y = 0; y < g.rows; ++y) {
      for (int x = 0; x < g.columns; ++x) {
        const bool hole = g.kind[static_cast<size_t>(y) * static_cast<size_t>(g.columns) + static_cast<size_t>(x)] == 0;
        sum[Index(x + 1, y + 1)] = sum[Index(x, y + 1)] + sum[Index(x + 1, y)] - sum[Index(x, y)] + (hole ? 1 : 0);
      }
    }
  }
  size_t Index(int x, int y) const {
    return static_cast<size_t>(y) * (static_cast<size_t>(g.columns) + 1) + static_cast<size_t>(x);
  }
  // Ground everywhere within reach_m of p, in x and in y.
  bool NoneAround(Vec2 p, float reach_m) const {
    const int x0 = static_cast<int>(std::floor((p.x - reach_m - g.min_m.x) / g.cell_m));
    const int y0 = static_cast<int>(std::floor((p.y - reach_m - g.min_m.y) / g.cell_m));
    const int x1 = static_cast<int>(std::floor((p.x + reach_m - g.min_m.x) / g.cell_m)) + 1;
    const int y1 = static_cast<int>(std::floor((p.y + reach_m - g.min_m.y) / g.cell_m)) + 1;
    if (x0 < 0 || y0 < 0 || x1 > g.columns || y1 > g.rows) return false;
    return sum[Index(x1, y1)] - sum[Index(x0, y1)] - sum[Index(x1, y0)] + sum[Index(x0, y0)] == 0;
  }
};

// Lower bounds: from the cell's centre less half its diagonal.
void MeasureClearances(const std::vector<char>& covered, float most_m, Walkable* w) {
  const Holes holes(*w->ground);
  const float half_m = 0.71f * w->cell_m;
  for (int cell = 0; cell < static_cast<int>(w->cost.size()); ++cell) {
    if (covered[static_cast<size_t>(cell)]) continue;
    const Vec2 center = CellCenter(*w, cell);
    float clear_m = std::min(most_m, Clearance(*w, cell, center) - half_m);
    while (clear_m > 0.05f && !holes.NoneAround(center, clear_m + half_m)) clear_m *= 0.7f;
    w->cells[static_cast<size_t>(cell)].clear_cm = clear_m > 0.05f ? static_cast<uint8_t>(clear_m * 100) : uint8_t{0};
  }
}

// Distances in kings' moves to the nearest cell that is steep or of another cost, less one, in two sweeps.
void MeasureSame(Walkable* w) {
  const auto level = [&](size_t cell) { return SlopeOf(*w, static_cast<int>(cell)) <= kLevelSlope; };
  const int columns = w->columns, rows = w->rows;
  const auto sweep = [&](int x, int y, int direction) {
    const int cell = y * columns + x;
    int least = direction > 0 ? kMaxUniformRadius_cells : w->cells[static_cast<size_t>(cell)].same;
    const int around[4] = {-direction, -direction * columns - 1, -direction * columns, -direction * columns + 1};
    for (int step : around) {
      const size_t other = static_cast<size_t>(cell + step);
      const bool alike =
          w->cost[other] == w->cost[static_cast<size_t>(cell)] && level(other) && level(static_cast<size_t>(cell));
      least = std::min(least, alike ? w->cells[other].same + 1 : 0);
    }
    w->cells[static_cast<size_t>(cell)].same = static_cast<uint8_t>(least);
  };
  for (int y = 1; y + 1 < rows; ++y) {
    for (int x = 1; x + 1 < columns; ++x) sweep(x, y, 1);
  }
  for (int y = rows - 2; y >= 1; --y) {
    for (int x = columns - 2; x >= 1; --x) sweep(x, y, -1);
  }
}

// The place in the cell where a person fits between walls on either side, which is no wider than that there: found from
// several points of the cell by pushing off whatever is too near.
bool FitsBetween(const Walkable& w, int cell, float radius_m, NearEdges* edges, Vec2* place) {
  constexpr float kPoints[] = {0, -0.45f, 0.45f};
  constexpr float kSloppy_m = 0.002f;
  const Vec2 center = CellCenter(w, cell);
  const float half_m = 0.5f * w.cell_m + kSloppy_m;
  edges->LookAt(w, cell);
  for (const float x : kPoints) {
    for (const float y : kPoints) {
      const Vec2 p = edges->PushedOff(center + Vec2{x, y} * w.cell_m, radius_m + kSloppy_m);
      if (std::abs(p.x - center.x) > half_m || std::abs(p.y - center.y) > half_m) continue;
      if (Clearance(w, cell, p) < radius_m || !HasWallsOnEitherSide(w, cell, p, radius_m + w.cell_m)) continue;
      *place = p;
      return true;
    }
  }
  return false;
}

// Opens the cells of the way through a door from a place in it, one way: until a cell that is free anyway, and no lone
// one before the door, as those around it are too.
void OpenAlong(Vec2 place, Vec2 along, float radius_m, const std::vector<float>& cost, NearEdges* edges, Walkable* w) {
  constexpr float kStep_m = 0.05f, kThickestWall_m = 3;
  const auto open = [&](int x, int y) {
    const int cell = y * w->columns + x, ground = GroundCell(*w->ground, CellCenter(*w, cell));
    const uint8_t kind = ground < 0 ? 0 : w->ground->kind[static_cast<size_t>(ground)];
    float& now = w->cost[static_cast<size_t>(cell)];
    if (now <= 0 && kind > 0 && kind <= 4) now = kGroundCost[kind] * kNarrowCost;
  };
  GridPlace last = PlaceAt(*w, place);
  open(last.x, last.y);
  for (float m = 0; m < kThickestWall_m; m += kStep_m) {
    const int before = CellAt(*w, place);
    edges->LookAt(*w, before);
    place = edges->PushedOff(place + along * kStep_m, radius_m);
    const GridPlace at = PlaceAt(*w, place);
    if (at.x < 0 || Clearance(*w, before, place) < radius_m - 0.001f) return;
    if (at.x != last.x && at.y != last.y) open(at.x, last.y);  // ways lead from side to side of cells
    const int cell = at.y * w->columns + at.x;
    if (cost[static_cast<size_t>(cell)] > 0 && Clearance(*w, cell, place) > w->person_radius_m + 0.25f * w->cell_m)
      return;
    open(at.x, at.y);
    last = at;
  }
}

// Doors that are wide enough for a person but miss the centres of cells. Nothing else is opened: only between walls on
// either side can't a whole cell hide another way.
void OpenNarrowDoors(const std::vector<char>& covered, float radius_m, Walkable* w) {
  const std::vector<float> cost = w->cost;
  NearEdges edges;
  const float around_m = 0.75f * w->cell_m;  // from a cell's centre to its corners, and a little more
  for (int cell = 0; cell < static_cast<int>(cost.size()); ++cell) {
    const size_t k = static_cast<size_t>(cell);
    const int near = w->wall_start[k + 1] - w->wall_start[k] + w->circle_start[k + 1] - w->circle_start[k];
    if (cost[k] > 0 || near < 2) continue;
    if (covered[k] && Clearance(*w, cell, CellCenter(*w, cell)) > around_m) continue;  // wholly inside an obstacle
    Vec2 place;
    if (!FitsBetween(*w, cell, radius_m, &edges, &place) || InsideObstacle(*w, place)) continue;
    const Vec2 aside = Unit(AwayFromNearest(*w, cell, place)), along{-aside.y, aside.x};
    OpenAlong(place, along, radius_m, cost, &edges, w);
    OpenAlong(place, along * -1, radius_m, cost, &edges, w);
  }
}

}  // namespace

void BuildWalkable(float person_radius_m, Walkable* w, float most_radius_m) {
  const GroundRaster& g = *w->ground;
  const Vec2 size{static_cast<float>(g.columns) * g.cell_m, static_cast<float>(g.rows) * g.cell_m};
  w->person_radius_m = person_radius_m;
  w->cell_m = std::max(kNavigationCell_m, std::sqrt(size.x * size.y / kMaxNavigationCells));
  w->min_m = g.min_m;
  w->cells_per_m = 1 / w->cell_m;
  w->columns = std::max(1, static_cast<int>(std::ceil(size.x / w->cell_m)));
  w->rows = std::max(1, static_cast<int>(std::ceil(size.y / w->cell_m)));
  const size_t cells = static_cast<size_t>(w->columns) * static_cast<size_t>(w->rows);
  w->cost.assign(cells, 0);
  w->least_cost = *std::max_element(std::begin(kGroundCost), std::end(kGroundCost));
  w->cells.assign(cells, {});
  w->edges.clear();
  w->polygon_boxes.clear();
  for (const PolygonObstacle& polygon : w->polygons) {
    w->polygon_boxes.push_back(BoxOf(polygon.outer));
    AddEdges(polygon.outer, &w->edges);
    for (const auto& hole : polygon.holes) AddEdges(hole, &w->edges);
  }
  BucketObstacles(std::max(person_radius_m, most_radius_m) + kReachBeyondRadius_m, w);
  const std::vector<char> covered = Covered(*w);
  for (int cell = 0; cell < static_cast<int>(cells); ++cell) {
    const Vec2 center = CellCenter(*w, cell);
    const int ground = GroundCell(g, center);
    const uint8_t kind = ground < 0 ? 0 : g.kind[static_cast<size_t>(ground)];
    if (kind == 0 || kind > 4 || covered[static_cast<size_t>(cell)]) continue;
    const float clearance_m = Clearance(*w, cell, center) - person_radius_m;
    if (clearance_m < 0) continue;
    w->cost[static_cast<size_t>(cell)] = kGroundCost[kind] * (clearance_m < kNearWall_m ? kNearWallCost : 1.0f);
    w->least_cost = std::min(w->least_cost, kGroundCost[kind]);
    w->cells[static_cast<size_t>(cell)].slope = static_cast<uint8_t>(SlopeAt(*w, center) / Walkable::kSlopeUnit);
  }
  OpenNarrowDoors(covered, std::max(person_radius_m - kByChoice_m, 0.05f), w);
  NumberComponents(w);
  MeasureOpenShares(covered, w);
  MeasureClearances(covered, std::max(person_radius_m, most_radius_m) + kReachBeyondRadius_m, w);
  MeasureSame(w);
}

Vec2 CellCenter(const Walkable& w, int cell) {
  return {w.min_m.x + (static_cast<float>(cell % w.columns) + 0.5f) * w.cell_m,
          w.min_m.y + (static_cast<float>(cell / w.columns) + 0.5f) * w.cell_m};
}

bool IsFree(const Walkable& w, Vec2 p) {
  const int cell = CellAt(w, p);
  return cell >= 0 && w.cost[static_cast<size_t>(cell)] > 0;
}

bool OnGround(const Walkable& w, Vec2 p) {
  const int ground = GroundCell(*w.ground, p);
  return ground >= 0 && w.ground->kind[static_cast<size_t>(ground)] != 0;
}

float HeightAt(const Walkable& w, Vec2 p) {
  const GroundRaster& g = *w.ground;
  if (g.height_m.empty()) return 0;
  const float fx = std::clamp((p.x - g.min_m.x) / g.cell_m - 0.5f, 0.0f, static_cast<float>(g.columns - 1));
  const float fy = std::clamp((p.y - g.min_m.y) / g.cell_m - 0.5f, 0.0f, static_cast<float>(g.rows - 1));
  const int x0 = static_cast<int>(fx), y0 = static_cast<int>(fy);
  const int x1 = std::min(x0 + 1, g.columns - 1), y1 = std::min(y0 + 1, g.rows - 1);
  const float tx = fx - static_cast<float>(x0), ty = fy - static_cast<float>(y0);
  float sum = 0, weight = 0;  // corners without ground don't count
  const auto corner = [&](int x, int y, float share) {
    const size_t i = static_cast<size_t>(y) * static_cast<size_t>(g.columns) + static_cast<size_t>(x);
    if (g.kind[i] == 0) return;
    sum += share * g.height_m[i];
    weight += share;
  };
  corner(x0, y0, (1 - tx) * (1 - ty));
  corner(x1, y0, tx * (1 - ty));
  corner(x0, y1, (1 - tx) * ty);
  corner(x1, y1, tx * ty);
  return weight > 1e-6f
             ? sum / weight
             : g.height_m[static_cast<size_t>(y0) * static_cast<size_t>(g.columns) + static_cast<size_t>(x0)];
}

bool InsideObstacle(const Walkable& w, Vec2 p) {
  for (const CircleObstacle& c : w.circles) {
    if (Length(p - c.center) < c.radius_m) return true;
  }
  for (size_t k = 0; k < w.polygons.size(); ++k) {
    const Walkable::Box& box = w.polygon_boxes[k];
    const bool may_be = p.x >= box.low.x && p.x <= box.high.x && p.y >= box.low.y && p.y <= box.high.y;
    if (may_be && InsidePolygon(p, w.polygons[k])) return true;
  }
  return false;
}

int NearestFreeCell(const Walkable& w, Vec2 p, float reach_m) {
  const int reach = static_cast<int>(std::ceil(reach_m / w.cell_m));
  const int cx = static_cast<int>(std::floor((p.x - w.min_m.x) / w.cell_m));
  const int cy = static_cast<int>(std::floor((p.y - w.min_m.y) / w.cell_m));
  int best = -1;
  float best_m = reach_m;
  for (int y = std::max(0, cy - reach); y <= std::min(w.rows - 1, cy + reach); ++y) {
    for (int x = std::max(0, cx - reach); x <= std::min(w.columns - 1, cx + reach); ++x) {
      const int cell = y * w.columns + x;
      if (w.cost[static_cast<size_t>(cell)] <= 0) continue;
      const float distance_m = Length(CellCenter(w, cell) - p);
      if (distance_m < best_m) {
        best_m = distance_m;
        best = cell;
      }
    }
  }
  return best;
}

int FreeCellFor(const Walkable& w, Vec2 p) {
  return IsFree(w, p) ? CellAt(w, p) : NearestFreeCell(w, p, kPlaceReach_m);
}

}  // namespace flaneur
