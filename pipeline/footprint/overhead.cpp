#include "pipeline/footprint/overhead.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/footprint/constants.h"

namespace flaneur {
namespace {

// Twice the area in plan, positive where seen from above anticlockwise.
double TwiceArea(const Triangle3& t) {
  const auto& [a, b, c] = t;
  return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}
bool IsUpright(const Triangle3& t) { return std::abs(TwiceArea(t)) < 1e-9; }

struct Box {
  double min_x, min_y, max_x, max_y;
};
Box BoxOf(const Triangle3& t) {
  const auto& [a, b, c] = t;
  return {std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})};
}

int64_t Cell(double v, double cell_m) { return static_cast<int64_t>(std::floor(v / cell_m)); }
int64_t Key(int64_t x, int64_t y) { return x * 1'000'003 + y; }

// As fine as the triangles are many, but so coarse that few of them lie over several cells.
double CellFor(const std::vector<const Triangle3*>& triangles) {
  Box all = BoxOf(*triangles[0]);
  for (const Triangle3* t : triangles) {
    const Box box = BoxOf(*t);
    all = {std::min(all.min_x, box.min_x), std::min(all.min_y, box.min_y), std::max(all.max_x, box.max_x),
           std::max(all.max_y, box.max_y)};
  }
  const auto count = static_cast<double>(triangles.size());
  double cell = std::max(kMinOverheadCell_m, std::sqrt((all.max_x - all.min_x) * (all.max_y - all.min_y) / count));
  const auto entries = [&] {
    double sum = 0;
    for (const Triangle3* t : triangles) {
      const Box box = BoxOf(*t);
      sum += ((box.max_x - box.min_x) / cell + 1) * ((box.max_y - box.min_y) / cell + 1);
    }
    return sum;
  };
  while (entries() > kMaxOverheadEntries * count) cell *= 2;
  return cell;
}

}  // namespace

Overhead::Overhead(const std::vector<const std::vector<Triangle3>*>& objects) {
  std::vector<const Triangle3*> triangles;
  for (const std::vector<Triangle3>* object : objects)
    for (const Triangle3& t : *object)
      if (!IsUpright(t)) triangles.push_back(&t);
  if (triangles.empty()) return;
  cell_m_ = CellFor(triangles);
  for (const Triangle3* t : triangles) {
    const Box box = BoxOf(*t);
    for (int64_t x = Cell(box.min_x, cell_m_); x <= Cell(box.max_x, cell_m_); ++x)
      for (int64_t y = Cell(box.min_y, cell_m_); y <= Cell(box.max_y, cell_m_); ++y)
        entries_.emplace_back(Key(x, y), t);
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.first < b.first; });
}

double Overhead::LowestAbove(Point2 p, double z) const {
  double lowest = std::numeric_limits<double>::infinity();
  const int64_t key = Key(Cell(p.x, cell_m_), Cell(p.y, cell_m_));
  auto entry =
      std::lower_bound(entries_.begin(), entries_.end(), key, [](const Entry& e, int64_t k) { return e.first < k; });
  for (; entry != entries_.end() && entry->first == key; ++entry) {
    const auto& [a, b, c] = *entry->second;
    const double area = TwiceArea(*entry->second);
    const double wb = ((p.x - a.x) * (c.y - a.y) - (c.x - a.x) * (p.y - a.y)) / area;
    const double wc = ((b.x - a.x) * (p.y - a.y) - (p.x - a.x) * (b.y - a.y)) / area;
    if (wb < 0 || wc < 0 || wb + wc > 1) continue;
    const double height = a.z + wb * (b.z - a.z) + wc * (c.z - a.z);
    if (height > z) lowest = std::min(lowest, height);
  }
  return lowest;
}

bool Overhead::Covers(Point2 p, double z) const { return std::isfinite(LowestAbove(p, z)); }

}  // namespace flaneur
