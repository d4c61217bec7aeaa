#include "runtime/crowd/neighbours.h"

namespace flaneur {

void SortIntoGrid(const Walkable& w, const std::vector<Vec2>& position, const std::vector<Vec2>& velocity,
                  const std::vector<float>& radius_m, const std::vector<uint8_t>& include, float cell_m, NeighbourGrid* g) {
  g->min_m = w.min_m;
  g->cell_m = cell_m;
  g->columns = static_cast<int>(static_cast<float>(w.columns) * w.cell_m / cell_m) + 1;
  g->rows = static_cast<int>(static_cast<float>(w.rows) * w.cell_m / cell_m) + 1;
  g->start.assign(static_cast<size_t>(g->columns) * static_cast<size_t>(g->rows) + 1, 0);
  g->cell_of.resize(position.size());
  for (size_t i = 0; i < position.size(); ++i) {
    if (!include[i]) continue;
    const int x = CellIndex(position[i].x, g->min_m.x, cell_m, g->columns);
    const int y = CellIndex(position[i].y, g->min_m.y, cell_m, g->rows);
    g->cell_of[i] = y * g->columns + x;
    ++g->start[static_cast<size_t>(g->cell_of[i])];
  }
  int end = 0;  // start[c] becomes the end of cell c, and sinks to its start while people are put in backwards
  for (int& s : g->start) s = end += s;
  g->people.reserve(position.size());  // once for all: more may take care in the next step
  g->people.resize(static_cast<size_t>(end));
  for (size_t i = position.size(); i-- > 0;) {
    if (!include[i]) continue;
    const int slot = --g->start[static_cast<size_t>(g->cell_of[i])];
    g->people[static_cast<size_t>(slot)] = {position[i], velocity[i], radius_m[i], static_cast<int>(i)};
  }
}

}  // namespace flaneur
