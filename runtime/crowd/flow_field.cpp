#include "runtime/crowd/flow_field.h"

#include <cmath>
#include <limits>
#include <queue>

namespace flaneur {
namespace {

constexpr float kSlopeCost = 4;
constexpr float kGoalReach_m = 3;
constexpr int kLookAhead_cells = 14;  // 7 m: farther corners are seen in time all the same

constexpr int kStepX[8] = {1, -1, 0, 0, 1, 1, -1, -1};
constexpr int kStepY[8] = {0, 0, 1, -1, 1, -1, 1, -1};

bool FreeCell(const Walkable& w, int x, int y) {
  return x >= 0 && y >= 0 && x < w.columns && y < w.rows && w.cost[static_cast<size_t>(y * w.columns + x)] > 0;
}

// The neighbour in direction k, -1 where it is blocked or a corner would be cut.
int Neighbour(const Walkable& w, int cell, int k) {
  const int x = cell % w.columns + kStepX[k], y = cell / w.columns + kStepY[k];
  if (!FreeCell(w, x, y)) return -1;
  if (k >= 4 && (!FreeCell(w, x, cell / w.columns) || !FreeCell(w, cell % w.columns, y))) return -1;
  return y * w.columns + x;
}

bool SeesPoint(const Walkable& w, Vec2 from, Vec2 to) {
  const Vec2 way = to - from;
  const int steps = static_cast<int>(std::ceil(Length(way) / (w.cell_m * 0.4f)));
  for (int i = 1; i < steps; ++i) {
    if (!IsFree(w, from + way * (static_cast<float>(i) / static_cast<float>(steps)))) return false;
  }
  return true;
}

}  // namespace

FlowField BuildFlowField(const Walkable& w, Vec2 goal) {
  FlowField field{goal, std::vector<float>(w.cost.size(), std::numeric_limits<float>::infinity())};
  const int start = IsFree(w, goal) ? CellAt(w, goal) : NearestFreeCell(w, goal, kGoalReach_m);
  if (start < 0) return field;
  using Entry = std::pair<float, int>;  // ties by cell: the same everywhere
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  field.distance[static_cast<size_t>(start)] = 0;
  open.push({0, start});
  while (!open.empty()) {
    const auto [distance, cell] = open.top();
    open.pop();
    if (distance > field.distance[static_cast<size_t>(cell)]) continue;
    for (int k = 0; k < 8; ++k) {
      const int next = Neighbour(w, cell, k);
      if (next < 0) continue;
      const float step_m = w.cell_m * (k < 4 ? 1.0f : 1.41421356f);
      const float rise = std::abs(w.height_m[static_cast<size_t>(next)] - w.height_m[static_cast<size_t>(cell)]);
      const float cost = 0.5f * (w.cost[static_cast<size_t>(next)] + w.cost[static_cast<size_t>(cell)]);
      const float total = distance + cost * (step_m + kSlopeCost * rise);
      if (total < field.distance[static_cast<size_t>(next)]) {
        field.distance[static_cast<size_t>(next)] = total;
        open.push({total, next});
      }
    }
  }
  return field;
}

bool Reachable(const Walkable& w, const FlowField& field, Vec2 from) {
  const int cell = IsFree(w, from) ? CellAt(w, from) : NearestFreeCell(w, from, kGoalReach_m);
  return cell >= 0 && std::isfinite(field.distance[static_cast<size_t>(cell)]);
}

Vec2 Waypoint(const Walkable& w, const FlowField& field, Vec2 p) {
  int cell = IsFree(w, p) ? CellAt(w, p) : NearestFreeCell(w, p, kGoalReach_m);
  if (cell < 0) return p;
  Vec2 seen = CellCenter(w, cell);
  for (int i = 0; i < kLookAhead_cells; ++i) {
    int best = -1;
    float best_distance = field.distance[static_cast<size_t>(cell)];
    for (int k = 0; k < 8; ++k) {
      const int next = Neighbour(w, cell, k);
      if (next >= 0 && field.distance[static_cast<size_t>(next)] < best_distance) {
        best = next;
        best_distance = field.distance[static_cast<size_t>(next)];
      }
    }
    if (best < 0) return SeesPoint(w, p, field.goal) ? field.goal : seen;  // at the goal's cell
    cell = best;
    const Vec2 center = CellCenter(w, cell);
    if (i > 0 && !SeesPoint(w, p, center)) break;
    seen = center;
  }
  return seen;
}

}  // namespace flaneur
