// Boxes by the cells of a grid that they reach into: which lie near a place, in a city of any size.
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <unordered_map>
#include <vector>

#include "pipeline/footprint/polygon_sets.h"

namespace flaneur {

class BoxGrid {
 public:
  // Boxes of nothing (min above max) are never found.
  explicit BoxGrid(std::vector<BoundingBox> boxes);

  // The numbers of the boxes that come within reach_m of this one, ascending.
  std::vector<size_t> Near(const BoundingBox& box, double reach_m = 0) const;

  // The numbers of all boxes in such an order that, once `limit_m` no longer grows past one's distance from `p`, the
  // rest is farther: calls visit(number) until a ring of cells lies beyond limit_m(), which may shrink meanwhile.
  template <typename Visit, typename Limit>
  void Outwards(Point2 p, const Visit& visit, const Limit& limit_m) const;

  const std::vector<BoundingBox>& boxes() const { return boxes_; }

 private:
  static constexpr double kCell_m = 32;
  static int64_t Cell(double v);
  static int64_t Key(int64_t x, int64_t y) { return x * 4'000'037 + y; }

  std::vector<BoundingBox> boxes_;
  std::unordered_map<int64_t, std::vector<size_t>> cells_;
  std::vector<size_t> wide_;  // reach into too many cells
  int64_t min_x_ = 0, min_y_ = 0, max_x_ = -1, max_y_ = -1;
};

template <typename Visit, typename Limit>
void BoxGrid::Outwards(Point2 p, const Visit& visit, const Limit& limit_m) const {
  for (const size_t i : wide_) visit(i);
  if (max_x_ < min_x_) return;
  const int64_t x = Cell(p.x), y = Cell(p.y);
  const int64_t first = std::max<int64_t>({0, min_x_ - x, x - max_x_, min_y_ - y, y - max_y_});
  const int64_t last =
      std::max({std::abs(min_x_ - x), std::abs(max_x_ - x), std::abs(min_y_ - y), std::abs(max_y_ - y)});
  const auto look = [&](int64_t cx, int64_t cy) {
    const auto found = cells_.find(Key(cx, cy));
    if (found == cells_.end()) return;
    for (const size_t i : found->second) visit(i);
  };
  for (int64_t ring = first; ring <= last && static_cast<double>(ring - 1) * kCell_m < limit_m(); ++ring) {
    for (int64_t cx = std::max(x - ring, min_x_); cx <= std::min(x + ring, max_x_); ++cx) {
      const bool edge = cx == x - ring || cx == x + ring;
      if (edge) {
        for (int64_t cy = std::max(y - ring, min_y_); cy <= std::min(y + ring, max_y_); ++cy) look(cx, cy);
      } else {
        look(cx, y - ring), look(cx, y + ring);
      }
    }
  }
}

}  // namespace flaneur
