#include "runtime/walk/flight.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/fast_math.h"
#include "runtime/crowd/walls.h"
#include "runtime/walk/route.h"

namespace flaneur {
namespace {

constexpr float kSpeed_mps = 1.1f, kAccelerates_mps2 = 0.25f, kLeast_mps = 0.05f;
constexpr int kRounds = 120;  // of pulling the way straight and away from walls
constexpr float kPull = 0.35f, kPush_m = 0.12f, kFeel_m = 0.75f;
constexpr float kLeastRoom_m = 0.8f;                // to what stands at the way; less where there is less
constexpr float kFromPosts_m = 1.2f;                // and to lamp posts and trunks, too thin to be felt from afar
constexpr float kCloseTo_m = 1.6f, kFarFrom_m = 5;  // of things: the lowest and the highest flight
constexpr float kSees_m = 3.5f;                     // along the way, that heights are evened out over

float RoomAt(const Walkable& w, Vec2 p) {
  const int cell = CellAt(w, p);
  return cell < 0 || w.component[static_cast<size_t>(cell)] < 0 ? 0
                                                                : 0.01f * w.cells[static_cast<size_t>(cell)].clear_cm;
}

float ToThings_m(const Walkable& w, Vec2 p, float most_m) {
  float least_m = most_m;
  for (const Walkable::Edge& e : w.edges) least_m = std::min(least_m, Length(NearestOnSegment(p, e.a, e.b) - p));
  for (const CircleObstacle& c : w.circles) least_m = std::min(least_m, Length(c.center - p) - c.radius_m);
  return std::max(0.0f, least_m);
}

std::vector<Vec2> Sampled(const Route& route) {
  const float length_m = LengthOf_m(route);
  const int parts = std::max(1, static_cast<int>(std::ceil(length_m / kFlightStep_m)));
  std::vector<Vec2> points;
  for (int k = 0; k <= parts; ++k)
    points.push_back(PointAt(route, length_m * static_cast<float>(k) / static_cast<float>(parts)));
  return points;
}

// How far from where they stand too near to p posts push it.
Vec2 AwayFromPosts(const Walkable& w, Vec2 p) {
  Vec2 away;
  for (const CircleObstacle& post : w.circles) {
    const float gap_m = Length(p - post.center) - post.radius_m;
    if (gap_m < kFromPosts_m) away = away + Unit(p - post.center) * (kFromPosts_m - gap_m);
  }
  return away;
}

// What passes a post where there is no room to keep off it, as between a lamp and a house, passes it on its other side.
void ChangeSides(const Walkable& w, std::vector<Vec2>* points) {
  const std::vector<Vec2> before = *points;
  for (size_t k = 1; k + 1 < before.size(); ++k) {
    const Vec2 p = before[k], along = Unit(before[k + 1] - before[k - 1]), left{-along.y, along.x};
    for (const CircleObstacle& post : w.circles) {
      const Vec2 off = p - post.center;
      if (Length(off) - post.radius_m >= kFromPosts_m) continue;
      const Vec2 beside = post.center + along * Dot(off, along);
      const Vec2 out = left * (Dot(off, left) < 0 ? -1 : 1) * (post.radius_m + kFromPosts_m);
      if (RoomAt(w, beside + out) < kLeastRoom_m && RoomAt(w, beside - out) >= kLeastRoom_m)
        (*points)[k] = beside - out;
    }
  }
}

// Like a band that walls push away: in the middle of streets, in wide bends round corners.
void Relax(const Walkable& w, std::vector<Vec2>* points) {
  for (int round = 0; round < kRounds; ++round) {
    for (size_t k = 1; k + 1 < points->size(); ++k) {
      const Vec2 p = (*points)[k];
      const float room_m = RoomAt(w, p);
      const Vec2 away{RoomAt(w, p + Vec2{kFeel_m, 0}) - RoomAt(w, p - Vec2{kFeel_m, 0}),
                      RoomAt(w, p + Vec2{0, kFeel_m}) - RoomAt(w, p - Vec2{0, kFeel_m})};
      const Vec2 middle = ((*points)[k - 1] + (*points)[k + 1]) * 0.5f;
      const Vec2 to = p + (middle - p) * kPull + away * kPush_m + AwayFromPosts(w, p) * kPull;
      if (RoomAt(w, to) >= std::min(kLeastRoom_m, room_m)) (*points)[k] = to;
    }
  }
}

// Never higher than the lowest of what is near along the way, and without a sudden rise or fall.
void LayHeights(const Walkable& w, Flight* f) {
  const size_t count = f->points.size();
  std::vector<float> most_m(count), low_m(count);
  for (size_t k = 0; k < count; ++k) most_m[k] = FlightHeight_m(w, f->points[k]);
  const auto near = [&](size_t k, const auto& take) {
    for (size_t j = 0; j < count; ++j) {
      if (std::abs(f->at_m[j] - f->at_m[k]) <= kSees_m) take(j);
    }
  };
  for (size_t k = 0; k < count; ++k) {
    low_m[k] = most_m[k];
    near(k, [&](size_t j) { low_m[k] = std::min(low_m[k], most_m[j]); });
  }
  f->height_m.resize(count);
  for (size_t k = 0; k < count; ++k) {
    float sum_m = 0, of = 0;
    near(k, [&](size_t j) { sum_m += low_m[j], of += 1; });
    f->height_m[k] = sum_m / of;
  }
}

}  // namespace

float FlightHeight_m(const Walkable& w, Vec2 place) {
  const float share = (ToThings_m(w, place, kFarFrom_m) - kCloseTo_m) / (kFarFrom_m - kCloseTo_m);
  return kLowestFlight_m + (kHighestFlight_m - kLowestFlight_m) * std::clamp(share, 0.0f, 1.0f);
}

Flight PlanFlight(const Walkable& w, Vec2 from, Vec2 to, WaySearch* search) {
  Route route{{from}, {0}};
  const int cell = FreeCellFor(w, to);
  if (cell < 0 || !ExtendRoute(w, IsFree(w, to) ? to : CellCenter(w, cell), search, &route)) return {};
  Flight f;
  f.points = Sampled(route);
  ChangeSides(w, &f.points);
  Relax(w, &f.points);
  for (size_t k = 0; k < f.points.size(); ++k)
    f.at_m.push_back(k == 0 ? 0 : f.at_m.back() + Length(f.points[k] - f.points[k - 1]));
  LayHeights(w, &f);
  return f;
}

bool IsOver(const Flight& f) { return f.points.empty() || f.way_m >= f.at_m.back(); }

FlightPlace PlaceAt(const Flight& f, float way_m) {
  const auto next = std::upper_bound(f.at_m.begin(), f.at_m.end(), std::max(0.0f, way_m));
  if (next == f.at_m.end()) return {f.points.back(), f.height_m.back()};
  const auto k = static_cast<size_t>(next - f.at_m.begin());
  const float share = (std::max(0.0f, way_m) - f.at_m[k - 1]) / (f.at_m[k] - f.at_m[k - 1]);
  return {f.points[k - 1] + (f.points[k] - f.points[k - 1]) * share,
          f.height_m[k - 1] + (f.height_m[k] - f.height_m[k - 1]) * share};
}

void FlyOn(float passed_s, Flight* f) {
  if (IsOver(*f)) return;
  const float left_m = f->at_m.back() - f->way_m;
  const float most_mps = std::min(kSpeed_mps, std::sqrt(2 * kAccelerates_mps2 * left_m));
  f->speed_mps = std::clamp(f->speed_mps + kAccelerates_mps2 * passed_s, kLeast_mps, std::max(kLeast_mps, most_mps));
  f->way_m = std::min(f->at_m.back(), f->way_m + f->speed_mps * passed_s);
}

}  // namespace flaneur
