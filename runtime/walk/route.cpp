#include "runtime/walk/route.h"

#include <algorithm>

#include "runtime/crowd/fast_math.h"
#include "runtime/crowd/flow_field.h"
#include "runtime/crowd/walls.h"

namespace flaneur {
namespace {

constexpr int kMaxCorners = 400;  // of one part: more than any town has
constexpr float kMinCorner_m = 0.05f, kAsNear_m = 0.05f;
constexpr float kAhead_m[] = {1.2f, 0.6f,
                              0.3f};  // of the route, walked towards: shorter where the line there cuts a corner

constexpr float kRoom_m = 1.5f;  // wished for on either side of the route
constexpr float kBend_m = 0.8f;  // between points that can be moved
constexpr int kSides = 16;       // directions that are looked at
constexpr int kMostBends = 60;   // passes over all points
constexpr int kTries = 3;        // a whole step, half of it, a quarter
constexpr float kEvens = 0.2f, kPush_m = 0.4f, kStill_m = 0.01f;

// Away from what leaves less than kRoom_m, at most kPush_m.
Vec2 OffWalls(const Walkable& w, Vec2 p) {
  Vec2 push;
  for (int k = 0; k < kSides; ++k) {
    const Vec2 side = DirectionOf(2 * kPi * static_cast<float>(k) / kSides);
    float free_m = 0.5f * w.cell_m;
    while (free_m < kRoom_m && IsFree(w, p + side * free_m)) free_m += 0.5f * w.cell_m;
    if (free_m < kRoom_m) push = push - side * (1 - free_m / kRoom_m);
  }
  return ClampLength(push * (8 * kPush_m / kSides), kPush_m);
}

void Append(Vec2 p, Route* route) {
  route->at_m.push_back(route->points.empty() ? 0 : route->at_m.back() + Length(p - route->points.back()));
  route->points.push_back(p);
}

}  // namespace

bool ExtendRoute(const Walkable& w, Vec2 goal, WaySearch* search, Route* route) {
  const size_t before = route->points.size();
  for (int corners = 0; corners < kMaxCorners; ++corners) {
    const Vec2 p = route->points.back();
    if (Length(goal - p) < kMinCorner_m) return true;
    if (StraightWay(w, p, goal)) {
      Append(goal, route);
      return true;
    }
    Corner corner;
    WayByCorners(w, p, goal, true, &corner, search);
    if (!corner.known || Length(corner.point - p) < kMinCorner_m) break;
    Append(corner.point, route);
  }
  route->points.resize(before);
  route->at_m.resize(before);
  return false;
}

void MakeRoomOnRoute(const Walkable& w, size_t first, Route* route) {
  std::vector<Vec2> points{route->points[first]};
  for (size_t k = first + 1; k < route->points.size(); ++k) {
    const Vec2 from = points.back(), step = route->points[k] - from;
    const int parts = 1 + static_cast<int>(Length(step) / kBend_m);
    for (int part = 1; part <= parts; ++part)
      points.push_back(from + step * (static_cast<float>(part) / static_cast<float>(parts)));
  }
  // Who and whose neighbours stay where they are is not looked at again.
  std::vector<char> moved(points.size(), 1), moves(points.size(), 0);
  bool any = true;
  for (int pass = 0; pass < kMostBends && any; ++pass) {
    any = false;
    std::fill(moves.begin(), moves.end(), 0);
    for (size_t k = 1; k + 1 < points.size(); ++k) {
      if (!moved[k - 1] && !moved[k] && !moved[k + 1]) continue;
      const Vec2 before = points[k - 1], p = points[k], after = points[k + 1];
      Vec2 step = ((before + after) * 0.5f - p) * kEvens + OffWalls(w, p);
      for (int tries = 0; tries < kTries; ++tries, step = step * 0.5f) {
        if (!StraightWay(w, before, p + step) || !StraightWay(w, p + step, after)) continue;
        points[k] = p + step;
        moves[k] = Length(step) > kStill_m;
        any = any || moves[k];
        break;
      }
    }
    moved.swap(moves);
  }
  route->points.resize(first + 1);
  route->at_m.resize(first + 1);
  for (size_t k = 1; k < points.size(); ++k) Append(points[k], route);
}

Vec2 PointAt(const Route& route, float way_m) {
  const auto next = std::upper_bound(route.at_m.begin(), route.at_m.end(), std::max(way_m, 0.0f));
  if (next == route.at_m.end()) return route.points.back();
  const size_t k = static_cast<size_t>(next - route.at_m.begin());
  const float share = (std::max(way_m, 0.0f) - route.at_m[k - 1]) / (route.at_m[k] - route.at_m[k - 1]);
  return route.points[k - 1] + (route.points[k] - route.points[k - 1]) * share;
}

float WayTo(const Route& route, Vec2 p, float least_m, float most_m) {
  float best_m = std::clamp(least_m, 0.0f, LengthOf_m(route)), away_m = Length(PointAt(route, best_m) - p);
  for (size_t k = 0; k + 1 < route.points.size(); ++k) {
    if (route.at_m[k + 1] < least_m || route.at_m[k] > most_m) continue;
    const Vec2 on = NearestOnSegment(p, route.points[k], route.points[k + 1]);
    const float at_m = std::clamp(route.at_m[k] + Length(on - route.points[k]), least_m, most_m);
    const float off_m = Length(PointAt(route, at_m) - p);
    // Where the route comes back along itself, the later of both: else who turns round there never gets beyond it.
    if (off_m < away_m + kAsNear_m) best_m = at_m, away_m = std::min(off_m, away_m);
  }
  return best_m;
}

bool FreeLine(const Walkable& w, Vec2 p, Vec2 q) {
  const int steps = 1 + static_cast<int>(Length(q - p) / (0.5f * w.cell_m));
  for (int k = 0; k <= steps; ++k) {
    if (!IsFree(w, p + (q - p) * (static_cast<float>(k) / static_cast<float>(steps)))) return false;
  }
  return true;
}

Vec2 WayStraightOrRound(const Walkable& w, Vec2 p, Vec2 point, Corner* corner, WaySearch* search) {
  if (!FreeLine(w, p, point)) return WayByCorners(w, p, point, true, corner, search);
  *corner = {};
  return Unit(point - p);
}

Vec2 WayAlong(const Walkable& w, const Route& route, float way_m, Vec2 p, Corner* corner, WaySearch* search) {
  for (const float ahead_m : kAhead_m) {
    const Vec2 way = PointAt(route, way_m + ahead_m) - p;
    if (Length(way) > kMinCorner_m && FreeLine(w, p, p + way)) {
      *corner = {};
      return Unit(way);
    }
  }
  return WayStraightOrRound(w, p, PointAt(route, way_m + kAhead_m[1]), corner, search);
}

}  // namespace flaneur
