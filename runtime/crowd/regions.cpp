#include "runtime/crowd/regions.h"

#include <algorithm>
#include <utility>

#include "runtime/crowd/flow_field.h"

namespace flaneur {
namespace {

constexpr int kBlock_cells = 8;

bool SameBlock(const Walkable& w, int a, int b) {
  return a % w.columns / kBlock_cells == b % w.columns / kBlock_cells &&
         a / w.columns / kBlock_cells == b / w.columns / kBlock_cells;
}

// Calls visit(n) for the cells above, below and beside that are free.
template <typename Visit>
void VisitBeside(const Walkable& w, int cell, Visit visit) {
  const int x = cell % w.columns, y = cell / w.columns;
  const auto free = [&](int n) { return w.cost[static_cast<size_t>(n)] > 0; };
  if (x > 0 && free(cell - 1)) visit(cell - 1);
  if (x + 1 < w.columns && free(cell + 1)) visit(cell + 1);
  if (y > 0 && free(cell - w.columns)) visit(cell - w.columns);
  if (y + 1 < w.rows && free(cell + w.columns)) visit(cell + w.columns);
}

struct Patch {
  std::vector<int> cells;
  float mean_cost = 0;
};

void Flood(const Walkable& w, int seed, int number, Regions* r, Patch* patch) {
  patch->cells.assign(1, seed);
  patch->mean_cost = 0;
  r->region_of[static_cast<size_t>(seed)] = number;
  for (size_t k = 0; k < patch->cells.size(); ++k) {
    const int cell = patch->cells[k];
    patch->mean_cost += CostOfGround(w, cell);
    VisitBeside(w, cell, [&](int n) {
      if (r->region_of[static_cast<size_t>(n)] >= 0 || !SameBlock(w, n, seed)) return;
      r->region_of[static_cast<size_t>(n)] = number;
      patch->cells.push_back(n);
    });
  }
  patch->mean_cost /= static_cast<float>(patch->cells.size());
}

Vec2 MiddleOf(const Walkable& w, const std::vector<int>& cells) {
  Vec2 mean;
  for (int cell : cells) mean = mean + CellCenter(w, cell);
  mean = mean * (1 / static_cast<float>(cells.size()));
  const auto off2 = [&](int cell) {
    const Vec2 off = CellCenter(w, cell) - mean;
    return Dot(off, off);
  };
  return CellCenter(w, *std::min_element(cells.begin(), cells.end(), [&](int a, int b) { return off2(a) < off2(b); }));
}

}  // namespace

Regions BuildRegions(const Walkable& w) {
  Regions r;
  r.region_of.assign(w.cost.size(), -1);
  std::vector<float> mean_cost;
  Patch patch;
  for (int cell = 0; cell < static_cast<int>(w.cost.size()); ++cell) {
    if (w.cost[static_cast<size_t>(cell)] <= 0 || r.region_of[static_cast<size_t>(cell)] >= 0) continue;
    Flood(w, cell, static_cast<int>(r.point.size()), &r, &patch);
    r.point.push_back(MiddleOf(w, patch.cells));
    mean_cost.push_back(patch.mean_cost);
  }
  std::vector<std::pair<int, int>> touching;
  for (int cell = 0; cell < static_cast<int>(w.cost.size()); ++cell) {
    const int a = r.region_of[static_cast<size_t>(cell)];
    if (a < 0) continue;
    VisitBeside(w, cell, [&](int n) {
      if (const int b = r.region_of[static_cast<size_t>(n)]; b != a) touching.push_back({a, b});
    });
  }
  std::sort(touching.begin(), touching.end());
  touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
  r.start.assign(r.point.size() + 1, 0);
  for (const auto& [a, b] : touching) {
    ++r.start[static_cast<size_t>(a) + 1];
    r.neighbour.push_back(b);
    const size_t i = static_cast<size_t>(a), j = static_cast<size_t>(b);
    r.cost.push_back(0.5f * (mean_cost[i] + mean_cost[j]) * Length(r.point[i] - r.point[j]));
  }
  for (size_t k = 1; k < r.start.size(); ++k) r.start[k] += r.start[k - 1];
  return r;
}

}  // namespace flaneur
