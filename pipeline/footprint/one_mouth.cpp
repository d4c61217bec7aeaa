#include "pipeline/footprint/one_mouth.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/segment_grid.h"

namespace flaneur {
namespace {

bool Same(Point2 a, Point2 b) { return a.x == b.x && a.y == b.y; }

std::vector<Point2> LooseEnds(const std::vector<Segment>& walls, const Rings& solid, double reach_m) {
  std::map<std::pair<double, double>, int> count;
  for (const Segment& s : walls)
    for (const Point2 p : {s.a, s.b}) ++count[{p.x, p.y}];
  std::vector<Point2> ends;
  for (const auto& [place, n] : count) {
    const Point2 p{place.first, place.second};
    if (n > 1 || Contains(solid, p) || (!solid.empty() && DistanceToBoundary(solid, p) < reach_m)) continue;
    const bool meets = std::any_of(walls.begin(), walls.end(), [&](const Segment& s) {
      return !Same(s.a, p) && !Same(s.b, p) && DistanceToSegment(p, s.a, s.b) < reach_m;
    });
    if (!meets) ends.push_back(p);
  }
  return ends;
}

bool Cross(const Segment& s, const Segment& t) {
  const auto side = [](const Segment& l, Point2 p) {
    return (l.b.x - l.a.x) * (p.y - l.a.y) - (l.b.y - l.a.y) * (p.x - l.a.x);
  };
  return side(s, t.a) * side(s, t.b) < 0 && side(t, s.a) * side(t, s.b) < 0;
}

// Straight across from end to end, the nearest first; each end once.
std::vector<Segment> Gaps(const std::vector<Segment>& walls, const Rings& solid, double reach_m) {
  const std::vector<Point2> ends = LooseEnds(walls, solid, reach_m);
  if (ends.size() < 2 || ends.size() > kMaxWallEnds) return {};
  std::vector<std::tuple<double, size_t, size_t>> pairs;
  for (size_t i = 0; i < ends.size(); ++i)
    for (size_t j = i + 1; j < ends.size(); ++j)
      if (const double length = Length(Segment{ends[i], ends[j]}); length <= kMaxMouth_m)
        pairs.emplace_back(length, i, j);
  std::sort(pairs.begin(), pairs.end());
  std::vector<bool> taken(ends.size(), false);
  std::vector<Segment> gaps;
  for (const auto& [_, i, j] : pairs) {
    if (taken[i] || taken[j]) continue;
    const Segment gap{ends[i], ends[j]};
    if (std::any_of(walls.begin(), walls.end(), [&](const Segment& wall) { return Cross(gap, wall); })) continue;
    taken[i] = taken[j] = true;
    gaps.push_back(gap);
  }
  return gaps;
}

bool IsRoom(const Rings& region, const std::vector<Segment>& gaps, double reach_m) {
  int count = 0;
  double width = 0;
  for (const Segment& gap : gaps) {
    const Point2 middle{(gap.a.x + gap.b.x) / 2, (gap.a.y + gap.b.y) / 2};
    if (DistanceToBoundary(region, middle) > reach_m + kOnWall_m) continue;
    ++count;
    width = Length(gap);
  }
  return count == 1 && width <= kMaxMouthShare * Length(Outline(region)) &&
         !Offset(region, -kMinRoomToMouth * width / 2).empty();
}

}  // namespace

Rings RoomsWithOneMouth(const std::vector<Segment>& walls, const Rings& solid, double reach_m,
                        const std::function<bool(const Rings&)>& is_solid) {
  std::vector<Segment> lines = CutWhereTheyMeet(walls);
  const std::vector<Segment> gaps = Gaps(lines, solid, reach_m);
  if (gaps.empty()) return {};
  lines.insert(lines.end(), gaps.begin(), gaps.end());
  Rings rooms;
  for (const Rings& region : Enclosed(lines, solid, reach_m / 2))
    if (!region.empty() && IsRoom(region, gaps, reach_m) && is_solid(region))
      rooms.insert(rooms.end(), region.begin(), region.end());
  return rooms;
}

}  // namespace flaneur
