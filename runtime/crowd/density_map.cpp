#include "runtime/crowd/density_map.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

constexpr float kCell_m = 2;
constexpr float kMaxCells = 1e6f;  // larger areas get larger cells
constexpr float kMinArea_m2 = 1;   // of a cell: the strip that is left beside a wall crowds nobody

size_t CellOf(const DensityMap& m, Vec2 p) {
  const int x = std::clamp(static_cast<int>((p.x - m.min_m.x) * m.cells_per_m), 0, m.columns - 1);
  const int y = std::clamp(static_cast<int>((p.y - m.min_m.y) * m.cells_per_m), 0, m.rows - 1);
  return static_cast<size_t>(y * m.columns + x);
}

void Build(const Walkable& w, DensityMap* m) {
  const Vec2 size{static_cast<float>(w.columns) * w.cell_m, static_cast<float>(w.rows) * w.cell_m};
  m->min_m = w.min_m;
  m->cell_m = std::max(kCell_m, std::sqrt(size.x * size.y / kMaxCells));
  m->cells_per_m = 1 / m->cell_m;
  m->columns = static_cast<int>(size.x * m->cells_per_m) + 1;
  m->rows = static_cast<int>(size.y * m->cells_per_m) + 1;
  m->per_person_pm2.assign(static_cast<size_t>(m->columns) * static_cast<size_t>(m->rows), 0);
  m->density_pm2 = m->per_person_pm2;
  for (int cell = 0; cell < w.columns * w.rows; ++cell) {
    if (w.cost[static_cast<size_t>(cell)] > 0)
      m->per_person_pm2[CellOf(*m, CellCenter(w, cell))] += w.cell_m * w.cell_m;
  }
  for (float& area_m2 : m->per_person_pm2) area_m2 = 1 / std::max(area_m2, kMinArea_m2);
}

}  // namespace

void CountPeople(const Walkable& w, const std::vector<Vec2>& position, DensityMap* m) {
  if (m->cell_m <= 0) Build(w, m);
  std::fill(m->density_pm2.begin(), m->density_pm2.end(), 0.0f);
  for (Vec2 p : position) {
    const size_t cell = CellOf(*m, p);
    m->density_pm2[cell] += m->per_person_pm2[cell];
  }
}

float DensityAt_pm2(const DensityMap& m, Vec2 p) {
  if (m.cell_m <= 0) return 0;
  const float x = std::clamp((p.x - m.min_m.x) * m.cells_per_m - 0.5f, 0.0f, static_cast<float>(m.columns - 1));
  const float y = std::clamp((p.y - m.min_m.y) * m.cells_per_m - 0.5f, 0.0f, static_cast<float>(m.rows - 1));
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int right = x0 + 1 < m.columns ? 1 : 0, up = y0 + 1 < m.rows ? m.columns : 0;
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  const float* d = &m.density_pm2[static_cast<size_t>(y0 * m.columns + x0)];
  return (d[0] * (1 - fx) + d[right] * fx) * (1 - fy) + (d[up] * (1 - fx) + d[up + right] * fx) * fy;
}

float MostDensityBetween_pm2(const DensityMap& m, Vec2 p, Vec2 q) {
  if (m.cell_m <= 0) return 0;
  const int steps = static_cast<int>(Length(q - p) * m.cells_per_m) + 1;
  float most_pm2 = 0;
  for (int k = 0; k <= steps; ++k) {
    most_pm2 = std::max(most_pm2, DensityAt_pm2(m, p + (q - p) * (static_cast<float>(k) / static_cast<float>(steps))));
  }
  return most_pm2;
}

}  // namespace flaneur
