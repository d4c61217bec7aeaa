#include "pipeline/footprint/box_grid.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

constexpr double kMaxCells = 400;  // of one box; wider ones are looked at always

}  // namespace

int64_t BoxGrid::Cell(double v) { return static_cast<int64_t>(std::floor(std::clamp(v, -1e12, 1e12) / kCell_m)); }

BoxGrid::BoxGrid(std::vector<BoundingBox> boxes) : boxes_(std::move(boxes)) {
  bool any = false;
  for (size_t i = 0; i < boxes_.size(); ++i) {
    const BoundingBox& box = boxes_[i];
    if (!(box.min.x <= box.max.x && box.min.y <= box.max.y)) continue;
    const double cells = ((box.max.x - box.min.x) / kCell_m + 1) * ((box.max.y - box.min.y) / kCell_m + 1);
    if (!(cells <= kMaxCells)) {
      wide_.push_back(i);
      continue;
    }
    const int64_t x0 = Cell(box.min.x), x1 = Cell(box.max.x), y0 = Cell(box.min.y), y1 = Cell(box.max.y);
    min_x_ = any ? std::min(min_x_, x0) : x0, min_y_ = any ? std::min(min_y_, y0) : y0;
    max_x_ = any ? std::max(max_x_, x1) : x1, max_y_ = any ? std::max(max_y_, y1) : y1;
    any = true;
    for (int64_t x = x0; x <= x1; ++x)
      for (int64_t y = y0; y <= y1; ++y) cells_[Key(x, y)].push_back(i);
  }
}

std::vector<size_t> BoxGrid::Near(const BoundingBox& box, double reach_m) const {
  std::vector<size_t> found;
  const auto meets = [&](const BoundingBox& b) {
    return b.min.x <= box.max.x + reach_m && box.min.x <= b.max.x + reach_m && b.min.y <= box.max.y + reach_m &&
           box.min.y <= b.max.y + reach_m;
  };
  for (const size_t i : wide_)
    if (meets(boxes_[i])) found.push_back(i);
  const int64_t x0 = std::max(Cell(box.min.x - reach_m), min_x_), x1 = std::min(Cell(box.max.x + reach_m), max_x_);
  const int64_t y0 = std::max(Cell(box.min.y - reach_m), min_y_), y1 = std::min(Cell(box.max.y + reach_m), max_y_);
  for (int64_t x = x0; x <= x1; ++x) {
    for (int64_t y = y0; y <= y1; ++y) {
      const auto cell = cells_.find(Key(x, y));
      if (cell == cells_.end()) continue;
      for (const size_t i : cell->second)
        if (meets(boxes_[i])) found.push_back(i);
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace flaneur
