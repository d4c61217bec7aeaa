#include "pipeline/footprint/town_fit.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "pipeline/footprint/box_grid.h"

namespace flaneur {
namespace {

constexpr double kSameSize_m = 0.05;   // boxes whose sides differ by less may be each other's
constexpr double kSameShift_m = 0.03;  // shifts that differ by less are one
constexpr double kVoteCell_m = 0.1;    // of the grid on which shifts are counted
constexpr size_t kMinAgreeing = 3;     // obstacles that are shifted alike
constexpr double kMinInPlace = 0.3;    // of the obstacles: they lie in this town, whatever their outlines
constexpr size_t kMaxVoters = 2000;    // obstacles that are asked for shifts
constexpr size_t kMaxAlike = 50;       // houses of one size; more tell nothing

BoundingBox BoxOf(const Obstacle& o) {
  if (!o.outer.empty()) return BoundingBoxOf({o.outer});
  return {{o.center.x - o.radius_m, o.center.y - o.radius_m}, {o.center.x + o.radius_m, o.center.y + o.radius_m}};
}

std::vector<BoundingBox> BoxesOf(const Footprints& footprints) {
  std::vector<BoundingBox> boxes;
  for (const Obstacle& o : footprints.obstacles) {
    const BoundingBox box = BoxOf(o);
    if (std::isfinite(box.min.x + box.min.y + box.max.x + box.max.y)) boxes.push_back(box);
  }
  return boxes;
}

Point2 SizeOf(const BoundingBox& b) { return {b.max.x - b.min.x, b.max.y - b.min.y}; }

bool SameSize(const BoundingBox& a, const BoundingBox& b) {
  const Point2 s = SizeOf(a), t = SizeOf(b);
  return std::abs(s.x - t.x) < kSameSize_m && std::abs(s.y - t.y) < kSameSize_m;
}

// From b to a.
Point2 Between(const BoundingBox& a, const BoundingBox& b) {
  return {(a.min.x + a.max.x - b.min.x - b.max.x) / 2, (a.min.y + a.max.y - b.min.y - b.max.y) / 2};
}

double SharedArea(const BoundingBox& a, const BoundingBox& b) {
  const double x = std::min(a.max.x, b.max.x) - std::max(a.min.x, b.min.x);
  const double y = std::min(a.max.y, b.max.y) - std::max(a.min.y, b.min.y);
  return x > 0 && y > 0 ? x * y : 0;
}

double AreaOf(const BoundingBox& b) { return SizeOf(b).x * SizeOf(b).y; }

Point2 MedianOf(std::vector<Point2> points) {
  const auto middle = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
  std::nth_element(points.begin(), middle, points.end(), [](Point2 a, Point2 b) { return a.x < b.x; });
  const double x = middle->x;
  std::nth_element(points.begin(), middle, points.end(), [](Point2 a, Point2 b) { return a.y < b.y; });
  return {x, middle->y};
}

size_t CountNear(const std::vector<Point2>& points, Point2 p) {
  return static_cast<size_t>(std::count_if(points.begin(), points.end(),
                                           [&](Point2 q) { return std::hypot(q.x - p.x, q.y - p.y) < kSameShift_m; }));
}

bool Agree(size_t agreeing, size_t all) {
  return agreeing >= kMinAgreeing && static_cast<double>(agreeing) >= kFits * static_cast<double>(all);
}

// Where the obstacles overlap what they stand for.
TownFit FitInPlace(const std::vector<BoundingBox>& obstacles, const BoxGrid& truth) {
  std::vector<Point2> shifts;
  size_t there = 0;
  for (const BoundingBox& box : obstacles) {
    bool near = false, same = false;
    for (const size_t i : truth.Near(box)) {
      const BoundingBox& t = truth.boxes()[i];
      const double shared = SharedArea(box, t);
      near |= shared > 0.5 * (AreaOf(box) + AreaOf(t) - shared);
      if (!same && SameSize(box, t) && shared > 0) shifts.push_back(Between(box, t)), same = true;
    }
    there += near;
  }
  TownFit fit;
  fit.share = static_cast<double>(there) / static_cast<double>(obstacles.size());
  if (shifts.empty()) return fit;
  const Point2 shift = MedianOf(shifts);
  const size_t agreeing = CountNear(shifts, shift);
  if (!Agree(agreeing, obstacles.size())) return fit;
  return {static_cast<double>(agreeing) / static_cast<double>(obstacles.size()), {-shift.x, -shift.y}};
}

// Wherever they are: pairs of the same size vote for the shift between them.
TownFit FitAnywhere(const std::vector<BoundingBox>& obstacles, std::vector<BoundingBox> truth) {
  std::sort(truth.begin(), truth.end(), [](const auto& a, const auto& b) { return SizeOf(a).x < SizeOf(b).x; });
  const size_t stride = std::max<size_t>(1, obstacles.size() / kMaxVoters);
  const auto cell = [](double v) { return static_cast<int64_t>(std::floor(v / kVoteCell_m)); };
  const auto key = [](int64_t x, int64_t y) { return x * 1'000'000'007 + y; };
  std::unordered_map<int64_t, int> votes;
  std::vector<Point2> shifts;
  size_t voters = 0;
  for (size_t i = 0; i < obstacles.size(); i += stride) {
    const BoundingBox& box = obstacles[i];
    auto at = std::lower_bound(truth.begin(), truth.end(), SizeOf(box).x - kSameSize_m,
                               [](const BoundingBox& b, double width) { return SizeOf(b).x < width; });
    std::vector<Point2> own;
    for (; at != truth.end() && SizeOf(*at).x < SizeOf(box).x + kSameSize_m && own.size() <= kMaxAlike; ++at)
      if (SameSize(box, *at)) own.push_back(Between(box, *at));
    ++voters;
    if (own.size() > kMaxAlike) continue;
    for (const Point2& s : own) {
      shifts.push_back(s);
      for (int64_t x = cell(s.x) - 1; x <= cell(s.x) + 1; ++x)
        for (int64_t y = cell(s.y) - 1; y <= cell(s.y) + 1; ++y) ++votes[key(x, y)];
    }
  }
  TownFit best;
  int most = 0;
  Point2 shift;
  for (const Point2& s : shifts)
    if (const int n = votes[key(cell(s.x), cell(s.y))]; n > most) most = n, shift = s;
  std::vector<Point2> near;
  for (const Point2& s : shifts)
    if (std::abs(s.x - shift.x) < 2 * kVoteCell_m && std::abs(s.y - shift.y) < 2 * kVoteCell_m) near.push_back(s);
  if (near.empty()) return best;
  shift = MedianOf(near);
  const size_t agreeing = CountNear(near, shift);
  if (!Agree(agreeing, voters)) return best;
  return {static_cast<double>(agreeing) / static_cast<double>(voters), {-shift.x, -shift.y}};
}

}  // namespace

TownFit FitToTown(const Footprints& footprints, const PreparedTown& town) {
  const std::vector<BoundingBox> obstacles = BoxesOf(footprints);
  if (obstacles.empty() || town.own.obstacles.empty()) return {};
  const BoxGrid truth(BoxesOf(town.own));
  const TownFit here = FitInPlace(obstacles, truth);
  if (here.share >= kMinInPlace) return here;
  const TownFit there = FitAnywhere(obstacles, truth.boxes());
  return there.share > here.share ? there : here;
}

}  // namespace flaneur
