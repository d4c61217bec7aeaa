#include "runtime/crowd/way_search.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "runtime/crowd/flow_field.h"

namespace flaneur {
namespace {

constexpr float kHeuristicWeight =
    1.2f;  // weight of what is still estimated: ways get a little longer, searches much smaller
constexpr float kDiagonal = 1.41421356f;
constexpr float kAtCorner_m = 0.4f;
constexpr size_t kNextPoints = 2;  // of the way: searched for over the cells where no point is in sight
constexpr size_t kMinCells = 4;    // to a corner of a way over cells

void Reach(int node, float cost, int from, float left, SearchTable* t) {
  const size_t k = static_cast<size_t>(node);
  if (t->round_of[k] == t->round && t->cost[k] <= cost) return;
  t->round_of[k] = t->round;
  t->cost[k] = cost;
  t->from[k] = from;
  t->open.push_back({cost + kHeuristicWeight * left, node});
  std::push_heap(t->open.begin(), t->open.end(), std::greater<>());
}

// A*. left(node): no way from there to the goal is cheaper; spread(node, reach): calls reach(next, cost of the step).
// Fills t->way; false where there is none.
template <typename Left, typename Spread>
bool Search(size_t nodes, int start, int goal, Left left, Spread spread, SearchTable* t) {
  t->round_of.resize(nodes);
  t->cost.resize(nodes);
  t->from.resize(nodes);
  t->open.clear();
  t->way.clear();
  ++t->round;
  Reach(start, 0, -1, left(start), t);
  while (!t->open.empty()) {
    const int node = t->open.front().second;
    if (node == goal) break;
    std::pop_heap(t->open.begin(), t->open.end(), std::greater<>());
    t->open.pop_back();
    const float cost = t->cost[static_cast<size_t>(node)];
    spread(node, [&](int next, float step) {
      const size_t k = static_cast<size_t>(next);
      if (t->round_of[k] != t->round || cost + step < t->cost[k]) Reach(next, cost + step, node, left(next), t);
    });
  }
  if (t->open.empty()) return false;
  for (int node = goal; node >= 0; node = t->from[static_cast<size_t>(node)]) t->way.push_back(node);
  std::reverse(t->way.begin(), t->way.end());
  return true;
}

bool SearchRegions(const Walkable& w, int start, int goal, WaySearch* s) {
  const Regions& r = s->regions;
  const Vec2 end = r.point[static_cast<size_t>(goal)];
  const auto left = [&](int region) { return w.least_cost * Length(r.point[static_cast<size_t>(region)] - end); };
  const auto spread = [&](int region, auto reach) {
    for (int k = r.start[static_cast<size_t>(region)]; k < r.start[static_cast<size_t>(region) + 1]; ++k) {
      reach(r.neighbour[static_cast<size_t>(k)], r.cost[static_cast<size_t>(k)]);
    }
  };
  return Search(r.point.size(), start, goal, left, spread, &s->far);
}

bool IsOpen(const Walkable& w, int x, int y) {
  return x >= 0 && y >= 0 && x < w.columns && y < w.rows && w.cost[static_cast<size_t>(y * w.columns + x)] > 0;
}

bool SearchCells(const Walkable& w, int start, int goal, SearchTable* t) {
  const Vec2 end = CellCenter(w, goal);
  const auto left = [&](int cell) {
    const Vec2 off = CellCenter(w, cell) - end;
    const float x = std::abs(off.x), y = std::abs(off.y);
    return w.least_cost * (std::max(x, y) + (kDiagonal - 1) * std::min(x, y));
  };
  const auto spread = [&](int cell, auto reach) {
    const int x = cell % w.columns, y = cell / w.columns;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if ((dx == 0 && dy == 0) || !IsOpen(w, x + dx, y + dy) || !IsOpen(w, x + dx, y) || !IsOpen(w, x, y + dy))
          continue;
        const int next = cell + dy * w.columns + dx;
        const float length_m = (dx != 0 && dy != 0 ? kDiagonal : 1.0f) * w.cell_m;
        reach(next, 0.5f * length_m * (CostOfGround(w, cell) + CostOfGround(w, next)));
      }
    }
  };
  return Search(w.cost.size(), start, goal, left, spread, t);
}

// How many of the points, in order, are in sight from p, about.
size_t InSight(const Walkable& w, Vec2 p, const std::vector<Vec2>& points) {
  size_t seen = 0, next = 1;
  while (next <= points.size() && StraightWay(w, p, points[next - 1])) seen = next, next *= 2;
  size_t hidden = std::min(next, points.size() + 1);
  while (hidden - seen > 1) {
    const size_t middle = (seen + hidden) / 2;
    (StraightWay(w, p, points[middle - 1]) ? seen : hidden) = middle;
  }
  return seen;
}

// Over the cells to a point that is near but round a corner.
Vec2 CornerNear(const Walkable& w, Vec2 p, int start, Vec2 to, WaySearch* s) {
  const int end = FreeCellFor(w, to);
  if (end < 0 || !SearchCells(w, start, end, &s->near)) return p;
  s->points.clear();
  for (size_t k = 1; k < s->near.way.size(); ++k) s->points.push_back(CellCenter(w, s->near.way[k]));
  if (s->points.empty()) return to;
  const size_t corner = std::max(InSight(w, p, s->points), std::min(kMinCells, s->points.size()));
  return corner == s->points.size() ? to : s->points[corner - 1];
}

Vec2 FirstCorner(const Walkable& w, Vec2 p, Vec2 goal, WaySearch* s) {
  const int start = FreeCellFor(w, p), end = FreeCellFor(w, goal);
  if (start < 0 || end < 0 || w.component[static_cast<size_t>(start)] != w.component[static_cast<size_t>(end)])
    return p;
  const Regions& r = s->regions;
  if (!SearchRegions(w, r.region_of[static_cast<size_t>(start)], r.region_of[static_cast<size_t>(end)], s)) return p;
  s->points.clear();
  for (size_t k = 1; k + 1 < s->far.way.size(); ++k) s->points.push_back(r.point[static_cast<size_t>(s->far.way[k])]);
  s->points.push_back(goal);
  if (const size_t seen = InSight(w, p, s->points); seen > 0) return s->points[seen - 1];
  return CornerNear(w, p, start, s->points[std::min(kNextPoints, s->points.size()) - 1], s);
}

}  // namespace

Vec2 WayByCorners(const Walkable& w, Vec2 p, Vec2 goal, bool look, Corner* corner, WaySearch* s) {
  if (s->regions.region_of.size() != w.cost.size()) s->regions = BuildRegions(w);
  const bool there = Length(corner->point - p) < kAtCorner_m ||
                     Dot(p - corner->point, corner->point - corner->from) > 0;  // or past it: pushed by others
  if (!corner->known || there || (look && !StraightWay(w, p, corner->point)))
    *corner = {FirstCorner(w, p, goal, s), p, true};
  const Vec2 way = corner->point - p;
  const float way_m = Length(way);
  return way_m > 1e-3f ? way * (1 / way_m) : Vec2{};
}

}  // namespace flaneur
