// Who is near whom: people sorted into a uniform grid, copied side by side so that looking around reads memory in order.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/base/math.h"
#include "runtime/crowd/walkable.h"

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
  std::vector<int> start;           // columns * rows + 1: cell c holds people[start[c]] .. people[start[c + 1] - 1]
  std::vector<Neighbour> people;    // by cell, then by person index

  std::vector<int> cell_of;         // scratch
};

// Sorts everybody with include[i] != 0 (counting sort, stable).
void SortIntoGrid(const Walkable& w, const std::vector<Vec2>& position, const std::vector<Vec2>& velocity,
                  const std::vector<float>& radius_m, const std::vector<uint8_t>& include, float cell_m, NeighbourGrid* grid);

// Calls visit(neighbour) for everybody in the cells within reach_m of p, p's own occupant included.
template <typename Visit>
void VisitNear(const NeighbourGrid& g, Vec2 p, float reach_m, Visit visit) {
  const auto cell = [&](float v, float origin, int count) {
    const int k = static_cast<int>((v - origin) / g.cell_m);
    return k < 0 ? 0 : k >= count ? count - 1 : k;
  };
  const int x0 = cell(p.x - reach_m, g.min_m.x, g.columns), x1 = cell(p.x + reach_m, g.min_m.x, g.columns);
  const int y0 = cell(p.y - reach_m, g.min_m.y, g.rows), y1 = cell(p.y + reach_m, g.min_m.y, g.rows);
  for (int y = y0; y <= y1; ++y) {  // the cells of a row lie side by side
    const int last = g.start[static_cast<size_t>(y * g.columns + x1) + 1];
    for (int k = g.start[static_cast<size_t>(y * g.columns + x0)]; k < last; ++k) visit(g.people[static_cast<size_t>(k)]);
  }
}

}  // namespace flaneur
