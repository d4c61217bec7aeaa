#include "runtime/control/enclosure.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

constexpr uint8_t kNoWay = 0, kCutOff = 1, kOpen = 2;

size_t Index(const Enclosure& e, int x, int y) {
  return static_cast<size_t>(y) * static_cast<size_t>(e.columns) + static_cast<size_t>(x);
}

void Frame(const Walkable& w, Vec2 visitor, float reach_m, Enclosure* e) {
  const int reach = static_cast<int>(reach_m * w.cells_per_m);
  const int cx = static_cast<int>(std::floor((visitor.x - w.min_m.x) * w.cells_per_m));
  const int cy = static_cast<int>(std::floor((visitor.y - w.min_m.y) * w.cells_per_m));
  e->column = std::clamp(cx - reach, 0, w.columns);
  e->row = std::clamp(cy - reach, 0, w.rows);
  e->columns = std::clamp(cx + reach + 1, 0, w.columns) - e->column;
  e->rows = std::clamp(cy + reach + 1, 0, w.rows) - e->row;
}

void Open(int x, int y, Enclosure* e) {
  if (x < 0 || y < 0 || x >= e->columns || y >= e->rows || e->cut_off[Index(*e, x, y)] != kCutOff) return;
  e->cut_off[Index(*e, x, y)] = kOpen;
  e->stack.push_back(static_cast<int>(Index(*e, x, y)));
}

}  // namespace

void FindEnclosure(const Walkable& w, Vec2 visitor, Vec2 next, float keep_away_m, float reach_m, Enclosure* e) {
  Frame(w, visitor, reach_m, e);
  e->cut_off.assign(static_cast<size_t>(e->columns) * static_cast<size_t>(e->rows), kNoWay);
  for (int y = 0; y < e->rows; ++y) {
    for (int x = 0; x < e->columns; ++x) {
      const int cell = (e->row + y) * w.columns + e->column + x;
      if (w.cost[static_cast<size_t>(cell)] <= 0) continue;
      const Vec2 p = CellCenter(w, cell), off = p - visitor, off_next = p - next;
      const bool near = std::min(Dot(off, off), Dot(off_next, off_next)) < keep_away_m * keep_away_m;
      if (!near) e->cut_off[Index(*e, x, y)] = kCutOff;
    }
  }
  e->stack.clear();
  for (int x = 0; x < e->columns; ++x) Open(x, 0, e), Open(x, e->rows - 1, e);
  for (int y = 0; y < e->rows; ++y) Open(0, y, e), Open(e->columns - 1, y, e);
  while (!e->stack.empty()) {
    const int cell = e->stack.back(), x = cell % e->columns, y = cell / e->columns;
    e->stack.pop_back();
    Open(x - 1, y, e), Open(x + 1, y, e), Open(x, y - 1, e), Open(x, y + 1, e);
  }
}

bool IsCutOff(const Walkable& w, const Enclosure& e, Vec2 p) {
  const int cell = CellAt(w, p);
  if (cell < 0) return false;
  const int x = cell % w.columns - e.column, y = cell / w.columns - e.row;
  return x >= 0 && y >= 0 && x < e.columns && y < e.rows && e.cut_off[Index(e, x, y)] == kCutOff;
}

}  // namespace flaneur
