#include "pipeline/footprint/floors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/plan_raster.h"

namespace flaneur {
namespace {

bool IsLevel(const Triangle3& t) {
  const auto& [a, b, c] = t;
  const double x = (b.y - a.y) * (c.z - a.z) - (b.z - a.z) * (c.y - a.y);
  const double y = (b.z - a.z) * (c.x - a.x) - (b.x - a.x) * (c.z - a.z);
  const double z = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  return std::abs(z) > kMinLevelShare * std::hypot(x, y, z) && std::abs(z) > 1e-9;
}

// Cells of level faces that lie lowest, in connected parts.
class FloorFinder {
 public:
  explicit FloorFinder(const std::vector<Triangle3>& triangles) : triangles_(triangles) {
    Point3 min = triangles[0][0], max = min;
    for (const Triangle3& t : triangles) {
      for (const Point3& p : t) {
        min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
        max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
      }
    }
    lowest_ = BlankRaster({min.x, min.y}, {max.x, max.y});
    level_ = lowest_;
  }

  std::vector<Triangle3> Run(double least_share) {
    for (const Triangle3& t : triangles_) {
      DrawEdges(t, &lowest_), DrawArea(t, &lowest_);
      if (IsLevel(t)) DrawArea(t, &level_);
    }
    size_t covered = 0, floor = 0;
    is_floor_.assign(level_.height_m.size(), 0);
    for (int row = 0; row < level_.rows; ++row)
      for (int column = 0; column < level_.columns; ++column) {
        covered += lowest_.height_m[CellAt(lowest_, column, row)] != kNoHeight;
        if (IsLowest(column, row) && !is_floor_[CellAt(level_, column, row)]) floor += TakePart(column, row);
      }
    if (static_cast<double>(floor) < least_share * static_cast<double>(covered)) return {};
    std::vector<Triangle3> out;
    for (const Triangle3& t : triangles_)
      if (IsLevel(t) && LiesOnFloor(t)) out.push_back(t);
    return out;
  }

 private:
  enum State : char { kUnseen, kRefused, kFloor };

  bool Inside(int column, int row) const {
    return column >= 0 && row >= 0 && column < level_.columns && row < level_.rows;
  }
  float Level(int column, int row) const { return level_.height_m[CellAt(level_, column, row)]; }
  float Lowest(int column, int row) const { return lowest_.height_m[CellAt(lowest_, column, row)]; }
  bool IsLowest(int column, int row) const {
    return Inside(column, row) && Level(column, row) != kNoHeight &&
           Level(column, row) <= Lowest(column, row) + kFoot_m;
  }

  // Of the part round a cell, how many cells are floor: all or none.
  size_t TakePart(int column, int row) {
    std::vector<std::pair<int, int>> part{{column, row}};
    is_floor_[CellAt(level_, column, row)] = kRefused;
    size_t border = 0, over_lower = 0, over_nothing = 0, high_over_floor = 0;
    for (size_t k = 0; k < part.size(); ++k) {
      const auto [x, y] = part[k];
      const float z = Level(x, y);
      bool at_border = false, lower = false;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const int u = x + dx, v = y + dy;
          if (!Inside(u, v)) {
            at_border = true;
            continue;
          }
          lower |= Lowest(u, v) < z - kFoot_m;
          const bool same = IsLowest(u, v) && std::abs(Level(u, v) - z) <= kFoot_m;
          at_border |= !same;
          if (!same || (dx != 0 && dy != 0) || is_floor_[CellAt(level_, u, v)]) continue;
          is_floor_[CellAt(level_, u, v)] = kRefused;
          part.emplace_back(u, v);
        }
      }
      border += at_border || lower;
      over_lower += lower;
      if (!lower) continue;
      const float below = FloorBeside(x, y);
      over_nothing += below == kNoHeight;
      high_over_floor += below != kNoHeight && z - below > kPassageHeight_m;
    }
    const auto share = [&](size_t cells) { return static_cast<double>(cells) / static_cast<double>(border); };
    // A roof ends in the air; a ceiling hangs high over the floor beside it.
    if (over_lower > 0 && (share(over_lower) > kMaxHangingShare || share(over_nothing) > kMaxFreeShare)) return 0;
    if (2 * high_over_floor > over_lower) return 0;
    if (over_lower > 0 && !IsWide(part)) return 0;
    for (const auto& [x, y] : part) is_floor_[CellAt(level_, x, y)] = kFloor;
    return part.size();
  }

  // The height of a lower floor within two cells; kNoHeight: none.
  float FloorBeside(int column, int row) const {
    const float z = Level(column, row);
    float below = kNoHeight;
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx)
        if (IsLowest(column + dx, row + dy) && Level(column + dx, row + dy) < z - kFoot_m)
          below = std::min(below, Level(column + dx, row + dy));
    return below;
  }

  // Whether a square as wide as what may hang over lower parts finds room in it.
  bool IsWide(const std::vector<std::pair<int, int>>& part) const {
    auto [x0, y0] = part[0];
    int x1 = x0, y1 = y0;
    for (const auto& [x, y] : part)
      x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
    // With what lies round it, which is not inside; where the raster ends, nothing is.
    x0 = std::max(x0 - 1, 0), y0 = std::max(y0 - 1, 0);
    x1 = std::min(x1 + 1, level_.columns - 1), y1 = std::min(y1 + 1, level_.rows - 1);
    GroundRaster inside;
    inside.cell_m = level_.cell_m;
    inside.columns = x1 - x0 + 1, inside.rows = y1 - y0 + 1;
    inside.height_m.assign(static_cast<size_t>(inside.columns) * static_cast<size_t>(inside.rows), 0.0f);
    for (const auto& [x, y] : part) inside.height_m[CellAt(inside, x - x0, y - y0)] = 1;
    TakeLeast(static_cast<int>(std::ceil(kOverhang_m / inside.cell_m)) - 1, &inside);
    return std::any_of(inside.height_m.begin(), inside.height_m.end(), [](float v) { return v > 0; });
  }

  bool LiesOnFloor(const Triangle3& t) const {
    const Point3 middle{(t[0].x + t[1].x + t[2].x) / 3, (t[0].y + t[1].y + t[2].y) / 3, (t[0].z + t[1].z + t[2].z) / 3};
    const int column = ColumnAt(level_, middle.x), row = RowAt(level_, middle.y);
    return Inside(column, row) && is_floor_[CellAt(level_, column, row)] == kFloor &&
           std::abs(Level(column, row) - middle.z) <= kFoot_m;
  }

  const std::vector<Triangle3>& triangles_;
  GroundRaster lowest_, level_;
  std::vector<char> is_floor_;
};

// The lowest level faces, if all that is not upright fits over them: a house on one floor, as most are. Then there is
// no need to ask cell by cell. Else nothing.
std::vector<Triangle3> PlainFloorOf(const std::vector<Triangle3>& triangles) {
  double lowest = std::numeric_limits<double>::max();
  for (const Triangle3& t : triangles)
    for (const Point3& p : t) lowest = std::min(lowest, p.z);
  std::vector<Triangle3> floor;
  double floor_m2 = 0, others_m2 = 0;
  for (const Triangle3& t : triangles) {
    const bool is_low = std::all_of(t.begin(), t.end(), [&](const Point3& p) { return p.z <= lowest + kFoot_m; });
    if (is_low && IsLevel(t)) floor.push_back(t), floor_m2 += PlanArea(t);
    else if (!IsWall(t)) others_m2 += PlanArea(t);
  }
  if (floor_m2 < kMinPlainFloor * others_m2) floor.clear();
  return floor;
}

}  // namespace

std::vector<Triangle3> FloorOf(const std::vector<Triangle3>& triangles, double least_share) {
  if (triangles.empty()) return {};
  std::vector<Triangle3> floor = PlainFloorOf(triangles);
  return floor.empty() ? FloorFinder(triangles).Run(least_share) : floor;
}

}  // namespace flaneur
