// The walkable ground as a small graph: connected patches of a few metres and which of them touch. Long ways are
// searched for in it.
#pragma once
#include <vector>

#include "runtime/crowd/walkable.h"

namespace flaneur {

struct Regions {
  std::vector<int> region_of;         // by cell; -1: not free
  std::vector<Vec2> point;            // by region: the centre of its cell nearest to its middle
  std::vector<int> start, neighbour;  // region r touches neighbour[start[r]] .. neighbour[start[r + 1] - 1]
  std::vector<float> cost;            // from point to point, weighted metres; by entry of neighbour
};

// Blocks of 8 x 8 cells, each split into what is connected within it.
Regions BuildRegions(const Walkable& walkable);

}  // namespace flaneur
