#include <algorithm>
#include <cmath>

#include "pipeline/footprint/check_parts.h"
#include "pipeline/footprint/rasterize_ground.h"

namespace flaneur {
namespace {

constexpr double kCell_m = 0.1;
constexpr int kMostCells = 16'000'000;   // larger towns get coarser cells
constexpr double kMargin_m = 2;          // round the obstacles, where there is no town
constexpr double kSmallestGround_m2 = 1;
constexpr double kLargeShare = 0.1;      // of all free ground: more, and it is no courtyard

// Where a person's centre may be.
struct FreeGround {
  Point2 min;
  double cell_m = kCell_m;
  int columns = 0, rows = 0;
  std::vector<uint8_t> free;
  std::vector<int> region;        // -1: not free
  std::vector<int> cells_of;      // by region
  std::vector<int> first_of;      // by region: its first cell

  size_t At(int column, int row) const {
    return static_cast<size_t>(row) * static_cast<size_t>(columns) + static_cast<size_t>(column);
  }
  Point2 Centre(int column, int row) const { return {min.x + (column + 0.5) * cell_m, min.y + (row + 0.5) * cell_m}; }
  Point2 Centre(int cell) const { return Centre(cell % columns, cell / columns); }
};

void LayOut(Point2 min, Point2 max, FreeGround* ground) {
  while ((max.x - min.x) / ground->cell_m * ((max.y - min.y) / ground->cell_m) > kMostCells) ground->cell_m *= 2;
  ground->min = min;
  ground->columns = std::max(1, static_cast<int>(std::ceil((max.x - min.x) / ground->cell_m)));
  ground->rows = std::max(1, static_cast<int>(std::ceil((max.y - min.y) / ground->cell_m)));
  ground->free.assign(ground->At(0, ground->rows), 1);
}

// Takes away what an area covers, line by line.
void TakeAway(const Rings& rings, FreeGround* ground) {
  std::vector<std::vector<double>> crossings(static_cast<size_t>(ground->rows));
  for (const Ring& ring : rings) {
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const Point2 a = ring[j].y < ring[i].y ? ring[j] : ring[i], b = ring[j].y < ring[i].y ? ring[i] : ring[j];
      if (a.y == b.y) continue;
      const int first = std::max(0, static_cast<int>(std::ceil((a.y - ground->min.y) / ground->cell_m - 0.5)));
      const int last = std::min(ground->rows - 1, static_cast<int>(std::ceil((b.y - ground->min.y) / ground->cell_m - 0.5)) - 1);
      for (int row = first; row <= last; ++row) {
        const double y = ground->min.y + (row + 0.5) * ground->cell_m;
        crossings[static_cast<size_t>(row)].push_back(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
      }
    }
  }
  for (int row = 0; row < ground->rows; ++row) {
    std::vector<double>& line = crossings[static_cast<size_t>(row)];
    std::sort(line.begin(), line.end());
    for (size_t k = 0; k + 1 < line.size(); k += 2) {
      const int from = std::max(0, static_cast<int>(std::ceil((line[k] - ground->min.x) / ground->cell_m - 0.5)));
      const int to = std::min(ground->columns - 1, static_cast<int>(std::floor((line[k + 1] - ground->min.x) / ground->cell_m - 0.5)));
      for (int column = from; column <= to; ++column) ground->free[ground->At(column, row)] = 0;
    }
  }
}

void FindRegions(FreeGround* ground) {
  ground->region.assign(ground->free.size(), -1);
  std::vector<int> queue;
  for (int start = 0; start < static_cast<int>(ground->free.size()); ++start) {
    if (!ground->free[static_cast<size_t>(start)] || ground->region[static_cast<size_t>(start)] >= 0) continue;
    const int number = static_cast<int>(ground->cells_of.size());
    ground->cells_of.push_back(0);
    ground->first_of.push_back(start);
    ground->region[static_cast<size_t>(start)] = number;
    queue.assign(1, start);
    while (!queue.empty()) {
      const int cell = queue.back(), column = cell % ground->columns, row = cell / ground->columns;
      queue.pop_back();
      ++ground->cells_of.back();
      const auto visit = [&](int c, int r) {
        if (c < 0 || r < 0 || c >= ground->columns || r >= ground->rows) return;
        const size_t next = ground->At(c, r);
        if (!ground->free[next] || ground->region[next] >= 0) return;
        ground->region[next] = number;
        queue.push_back(static_cast<int>(next));
      };
      visit(column - 1, row), visit(column + 1, row), visit(column, row - 1), visit(column, row + 1);
    }
  }
}

class WaysCheck {
 public:
  explicit WaysCheck(CheckState* state) : state_(*state) {}

  Error Run(const Scene* town) {
    Rings all;
    Point2 min{1e300, 1e300}, max{-1e300, -1e300};
    for (const CheckedObstacle& entry : state_.obstacles) {
      if (!entry.sound) continue;
      all.insert(all.end(), entry.rings.begin(), entry.rings.end());
      min = {std::min(min.x, entry.min.x), std::min(min.y, entry.min.y)};
      max = {std::max(max.x, entry.max.x), std::max(max.y, entry.max.y)};
    }
    gates_ = state_.options.gates;
    if (town) {
      const std::vector<Gate> more = GatesOf(*town, state_.options.scale);
      gates_.insert(gates_.end(), more.begin(), more.end());
      GroundRasterOptions options;
      options.scale = state_.options.scale;
      if (Error error = RasterizeGround(*town, options, &raster_)) return error;
      min = {raster_.min_m.x, raster_.min_m.y};
      max = {min.x + raster_.columns * raster_.cell_m, min.y + raster_.rows * raster_.cell_m};
    } else {
      if (all.empty()) return Ok();
      min = {min.x - kMargin_m, min.y - kMargin_m}, max = {max.x + kMargin_m, max.y + kMargin_m};
    }
    area_ = UnionOfAreas(all);
    // Half a cell less than the radius: a way exactly as wide as a person counts as open.
    walk_ = MakeGround(min, max, state_.options.person_radius_m - kCell_m / 2);
    reach_ = MakeGround(min, max, 0);
    CheckGates();
    CheckRegions();
    return Ok();
  }

 private:
  FreeGround MakeGround(Point2 min, Point2 max, double grow) {
    FreeGround ground;
    LayOut(min, max, &ground);
    if (raster_.columns > 0) {
      for (int row = 0; row < ground.rows; ++row)
        for (int column = 0; column < ground.columns; ++column)
          ground.free[ground.At(column, row)] = HasGround(ground.Centre(column, row));
    }
    TakeAway(grow > 0 ? Offset(area_, grow) : area_, &ground);
    FindRegions(&ground);
    return ground;
  }

  bool HasGround(Point2 p) const {
    const int column = static_cast<int>((p.x - raster_.min_m.x) / raster_.cell_m);
    const int row = static_cast<int>((p.y - raster_.min_m.y) / raster_.cell_m);
    if (column < 0 || row < 0 || column >= raster_.columns || row >= raster_.rows) return false;
    return raster_.kind[static_cast<size_t>(row) * static_cast<size_t>(raster_.columns) + static_cast<size_t>(column)] != 0;
  }

  // The region round a place, within a person's radius of it; -1: none.
  int RegionNear(const FreeGround& ground, Point2 p) const {
    int best = -1;
    double nearest = state_.options.person_radius_m + ground.cell_m;
    const int reach = static_cast<int>(std::ceil(nearest / ground.cell_m));
    const int column = static_cast<int>(std::floor((p.x - ground.min.x) / ground.cell_m));
    const int row = static_cast<int>(std::floor((p.y - ground.min.y) / ground.cell_m));
    for (int r = std::max(0, row - reach); r <= std::min(ground.rows - 1, row + reach); ++r) {
      for (int c = std::max(0, column - reach); c <= std::min(ground.columns - 1, column + reach); ++c) {
        const Point2 q = ground.Centre(c, r);
        const double d = std::hypot(q.x - p.x, q.y - p.y);
        if (ground.free[ground.At(c, r)] && d < nearest) nearest = d, best = ground.region[ground.At(c, r)];
      }
    }
    return best;
  }

  // People step out of a door: a door may stand in the wall's clearance, a step ahead of it must be free.
  void CheckGates() {
    const double r = state_.options.person_radius_m;
    std::vector<int> regions;
    for (const Gate& gate : gates_) {
      const double step = std::hypot(gate.ahead.x, gate.ahead.y) > 0 ? r + state_.clearance_m + 0.05 : 0;
      const Point2 p{gate.at_m.x + step * gate.ahead.x, gate.at_m.y + step * gate.ahead.y};
      const double gap = DistanceToBoundary(area_, p);
      regions.push_back(-1);
      if (Contains(area_, p)) {
        state_.Add(gate.is_exit ? 602 : 601, gate.name, p, gap, 0, "'" + gate.name + "'");
        continue;
      }
      if (gap < r - state_.options.tolerance_m)
        state_.Add(603, gate.name, p, gap, r, Metres(gap) + " from '" + gate.name + "' to the nearest obstacle");
      regions.back() = RegionNear(walk_, p);
      if (regions.back() < 0 && gap >= r)
        state_.Add(604, gate.name, p, 0, 0, "'" + gate.name + "' stands on no ground");
    }
    main_ = MainRegion();
    bool any_exit = false;
    for (size_t i = 0; i < gates_.size(); ++i) any_exit |= gates_[i].is_exit && regions[i] >= 0;
    for (size_t i = 0; i < gates_.size(); ++i) {
      if (regions[i] < 0) continue;
      has_gate_.push_back(regions[i]);
      if (gates_[i].is_exit || !any_exit || ReachesExit(regions[i], regions)) continue;
      cut_off_.push_back(regions[i]);
      state_.Add(604, gates_[i].name, gates_[i].at_m, 0, 0, "no exit can be reached from '" + gates_[i].name + "'");
    }
  }

  bool ReachesExit(int region, const std::vector<int>& regions) const {
    for (size_t i = 0; i < gates_.size(); ++i)
      if (gates_[i].is_exit && regions[i] == region) return true;
    return false;
  }

  int MainRegion() const {
    const auto& sizes = walk_.cells_of;
    return sizes.empty() ? -1 : static_cast<int>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  }

  // 501. Ground that even a point cannot get to is a courtyard, unless it is a large part of the town or has a door.
  void CheckRegions() {
    if (main_ < 0) return;
    const double cell_area = walk_.cell_m * walk_.cell_m;
    const int main_reach = reach_.region[static_cast<size_t>(walk_.first_of[static_cast<size_t>(main_)])];
    for (size_t i = 0; i < walk_.cells_of.size(); ++i) {
      const double area = walk_.cells_of[i] * cell_area;
      if (static_cast<int>(i) == main_ || area < kSmallestGround_m2) continue;
      if (std::find(cut_off_.begin(), cut_off_.end(), static_cast<int>(i)) != cut_off_.end()) continue;  // said by 604
      const bool gate = std::find(has_gate_.begin(), has_gate_.end(), static_cast<int>(i)) != has_gate_.end();
      const bool large = walk_.cells_of[i] > kLargeShare * walk_.cells_of[static_cast<size_t>(main_)];
      const bool closed = reach_.region[static_cast<size_t>(walk_.first_of[i])] != main_reach;
      char size[40];
      std::snprintf(size, sizeof size, "%.1f m2", area);
      state_.Add(501, "", walk_.Centre(walk_.first_of[i]), area, kSmallestGround_m2,
                 std::string(size) + (closed ? ", closed all round" : ", cut off by narrow gaps"));
      if (closed && !gate && !large) state_.findings->back().severity = Severity::kWarning;
    }
  }

  CheckState& state_;
  std::vector<Gate> gates_;
  GroundRaster raster_;
  Rings area_;
  FreeGround walk_, reach_;
  int main_ = -1;
  std::vector<int> has_gate_, cut_off_;  // regions
};

}  // namespace

Error CheckWays(const Scene* town, CheckState* state) { return WaysCheck(state).Run(town); }

}  // namespace flaneur
