// The ground that the visitor cuts off: a dead end with the visitor in its mouth (paper, Fig. 13).
#pragma once
#include <cstdint>
#include <vector>

#include "runtime/crowd/walkable.h"

namespace flaneur {

// Cells of the navigation grid in a square about the visitor. Kept, so that looking again allocates nothing.
struct Enclosure {
  int column = 0, row = 0;  // of the square's south-west cell
  int columns = 0, rows = 0;
  std::vector<uint8_t> cut_off;  // by cell of the square
  std::vector<int> stack;        // scratch
};

// Marks the free cells within reach_m of the visitor, in x and in y, from where every way out of the square leads
// within keep_away_m of where the visitor is, or is about to be (`next`).
void FindEnclosure(const Walkable& w, Vec2 visitor, Vec2 next, float keep_away_m, float reach_m, Enclosure* enclosure);

bool IsCutOff(const Walkable& w, const Enclosure& enclosure, Vec2 p);

}  // namespace flaneur
