// Who is near whom: people sorted into a uniform grid, copied side by side so that looking around reads memory in
// order.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/base/math.h"

namespace flaneur {

// One person as the others see it; 24 bytes, so that a look around touches few cache lines.
struct Neighbour {
  Vec2 position, velocity;
  float radius_m = 0;
  int person = 0;
};

struct NeighbourGrid {
  Vec2 min_m;
  float cell_m = 1;
  int columns = 0, rows = 0;
  std::vector<int> start;         // columns * rows + 1: cell c holds people[start[c]] .. people[start[c + 1] - 1]
  std::vector<Neighbour> people;  // by cell, then by person index

  std::vector<int> cell_of;  // scratch
};

// Sorts these people, by their index (counting sort, stable). The grid spans them and no more.
void SortIntoGrid(const std::vector<int>& people, const std::vector<Vec2>& position, const std::vector<Vec2>& velocity,
                  const std::vector<float>& radius_m, float cell_m, NeighbourGrid* grid);

// Column or row of a coordinate, those outside in the outermost.
inline int CellIndex(float v, float origin, float cell_m, int count) {
  const int k = static_cast<int>((v - origin) * (1 / cell_m));
  return k < 0 ? 0 : k >= count ? count - 1 : k;
}

inline int CellOf(const NeighbourGrid& g, Vec2 p) {
  return CellIndex(p.y, g.min_m.y, g.cell_m, g.rows) * g.columns + CellIndex(p.x, g.min_m.x, g.cell_m, g.columns);
}

struct CellRange {
  int x0 = 0, x1 = 0, y0 = 0, y1 = 0;
};  // columns x0 to x1 of the rows y0 to y1

// The cells within reach_m of p.
inline CellRange CellsNear(const NeighbourGrid& g, Vec2 p, float reach_m) {
  return {CellIndex(p.x - reach_m, g.min_m.x, g.cell_m, g.columns),
          CellIndex(p.x + reach_m, g.min_m.x, g.cell_m, g.columns),
          CellIndex(p.y - reach_m, g.min_m.y, g.cell_m, g.rows), CellIndex(p.y + reach_m, g.min_m.y, g.cell_m, g.rows)};
}

// Calls visit(first, end) for each row of cells within reach_m of p: the people of a row's cells lie side by side in
// g.people.
template <typename Visit>
void VisitRows(const NeighbourGrid& g, Vec2 p, float reach_m, Visit visit) {
  const CellRange near = CellsNear(g, p, reach_m);
  for (int y = near.y0; y <= near.y1; ++y) {
    const int first = g.start[static_cast<size_t>(y * g.columns + near.x0)];
    const int end = g.start[static_cast<size_t>(y * g.columns + near.x1) + 1];
    if (first < end) visit(&g.people[static_cast<size_t>(first)], g.people.data() + end);
  }
}

// Calls visit(neighbour) for everybody in the cells within reach_m of p, p's own occupant included.
template <typename Visit>
void VisitNear(const NeighbourGrid& g, Vec2 p, float reach_m, Visit visit) {
  VisitRows(g, p, reach_m, [&](const Neighbour* first, const Neighbour* end) {
    for (const Neighbour* n = first; n < end; ++n) visit(*n);
  });
}

}  // namespace flaneur
