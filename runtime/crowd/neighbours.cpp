#include "runtime/crowd/neighbours.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

constexpr float kMostCells = 4e6f;  // people far from each other get larger cells

void Span(const std::vector<int>& people, const std::vector<Vec2>& position, float cell_m, NeighbourGrid* g) {
  Vec2 min{}, max{};
  if (!people.empty()) min = max = position[static_cast<size_t>(people[0])];
  for (int person : people) {
    const Vec2 p = position[static_cast<size_t>(person)];
    min = {std::min(min.x, p.x), std::min(min.y, p.y)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y)};
  }
  g->min_m = min;
  const Vec2 cells = (max - min) * (1 / cell_m);
  g->cell_m = cell_m * std::max(1.0f, std::sqrt((cells.x + 1) * (cells.y + 1) / kMostCells));
  cell_m = g->cell_m;
  g->columns = static_cast<int>((max.x - min.x) / cell_m) + 1;
  g->rows = static_cast<int>((max.y - min.y) / cell_m) + 1;
}

}  // namespace

void SortIntoGrid(const std::vector<int>& people, const std::vector<Vec2>& position, const std::vector<Vec2>& velocity,
                  const std::vector<float>& radius_m, float cell_m, NeighbourGrid* g) {
  Span(people, position, cell_m, g);
  const size_t cells = static_cast<size_t>(g->columns) * static_cast<size_t>(g->rows);
  g->start.reserve(2 * cells);  // the grid may span more in the next step
  g->start.assign(cells + 1, 0);
  g->cell_of.reserve(position.size());
  g->cell_of.resize(people.size());
  for (size_t k = 0; k < people.size(); ++k) {
    g->cell_of[k] = CellOf(*g, position[static_cast<size_t>(people[k])]);
    ++g->start[static_cast<size_t>(g->cell_of[k])];
  }
  int end = 0;  // start[c] becomes the end of cell c, and sinks to its start while people are put in backwards
  for (int& s : g->start) s = end += s;
  g->people.reserve(position.size());  // once for all: more may take care in the next step
  g->people.resize(people.size());
  for (size_t k = people.size(); k-- > 0;) {
    const size_t i = static_cast<size_t>(people[k]);
    const int slot = --g->start[static_cast<size_t>(g->cell_of[k])];
    g->people[static_cast<size_t>(slot)] = {position[i], velocity[i], radius_m[i], people[k]};
  }
}

}  // namespace flaneur
