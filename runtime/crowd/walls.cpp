#include "runtime/crowd/walls.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/constants.h"

namespace flaneur {
namespace {

constexpr float kTolerance_m = 1e-3f;
constexpr float kComesOff_m = 0.01f;  // a step, for who starts closer than their radius: at once they would shoot off
constexpr int kSlides = 3;            // a corner needs two
constexpr int kPushes = 24;
constexpr float kOpposite = 0.7f;

// Calls visit(away, distance_m) for all walls and trees near the cell: `away` from the nearest point to p, distance_m
// to it.
template <typename Visit>
void VisitWalls(const Walkable& w, int cell, Vec2 p, Visit visit) {
  const size_t k = static_cast<size_t>(cell);
  for (int i = w.wall_start[k]; i < w.wall_start[k + 1]; ++i) {
    const Walkable::Edge& e = w.edges[static_cast<size_t>(w.wall_edges[static_cast<size_t>(i)])];
    const Vec2 away = p - NearestOnSegment(p, e.a, e.b);
    visit(away, Length(away));
  }
  for (int i = w.circle_start[k]; i < w.circle_start[k + 1]; ++i) {
    const CircleObstacle& c = w.circles[static_cast<size_t>(w.wall_circles[static_cast<size_t>(i)])];
    const Vec2 off = p - c.center;
    const float length = Length(off);
    const float distance_m = length - c.radius_m;
    visit(length > 1e-6f ? off * (distance_m / length) : Vec2{}, distance_m);
  }
}

bool NothingNear(const Walkable& w, int cell) {
  const size_t k = static_cast<size_t>(cell);
  return w.wall_start[k] == w.wall_start[k + 1] && w.circle_start[k] == w.circle_start[k + 1];
}

void Push(Vec2 away, float distance_m, float radius_m, Vec2* p) {
  if (distance_m >= radius_m || std::abs(distance_m) < 1e-5f) return;
  *p = *p + away * ((radius_m - distance_m) / distance_m);
}

void PushOutOfEdge(const Walkable::Edge& e, float radius_m, Vec2* p) {
  const float far_m2 = radius_m * radius_m * 1.0001f;  // certainly out of reach, without a root
  const Vec2 away = *p - NearestOnSegment(*p, e.a, e.b);
  if (Dot(away, away) < far_m2) Push(away, Length(away), radius_m, p);
}

void PushOutOfCircles(const Walkable& w, int cell, float radius_m, Vec2* p) {
  const size_t k = static_cast<size_t>(cell);
  for (int i = w.circle_start[k]; i < w.circle_start[k + 1]; ++i) {
    const CircleObstacle& c = w.circles[static_cast<size_t>(w.wall_circles[static_cast<size_t>(i)])];
    const Vec2 off = *p - c.center;
    const float length = Length(off);
    if (length > 1e-6f) Push(off * ((length - c.radius_m) / length), length - c.radius_m, radius_m, p);
  }
}

Vec2 PushOut(const Walkable& w, int cell, Vec2 p, float radius_m) {
  const size_t k = static_cast<size_t>(cell);
  for (int i = w.wall_start[k]; i < w.wall_start[k + 1]; ++i)
    PushOutOfEdge(w.edges[static_cast<size_t>(w.wall_edges[static_cast<size_t>(i)])], radius_m, &p);
  PushOutOfCircles(w, cell, radius_m, &p);
  return p;
}

// Until nothing pushes any more.
Vec2 PushedBy(auto push_out, Vec2 p) {
  for (int push = 0; push < kPushes; ++push) {
    const Vec2 pushed = push_out(p);
    if (pushed.x == p.x && pushed.y == p.y) break;
    p = pushed;
  }
  return p;
}

// One step no longer than half the radius: too short to reach a wall's other side.
Vec2 ShortStep(const Walkable& w, Vec2 from, Vec2 to, float radius_m) {
  const int cell = CellAt(w, from);
  if (cell < 0) return from;
  const bool was_on_ground = OnGround(w, from);
  const auto grounded = [&](Vec2 p) { return !was_on_ground || OnGround(w, p); };
  if (NothingNear(w, cell)) {
    if (grounded(to)) return to;
    if (grounded({to.x, from.y})) return {to.x, from.y};
    return grounded({from.x, to.y}) ? Vec2{from.x, to.y} : from;
  }
  if (Clearance(w, cell, to) >= radius_m && grounded(to)) return to;  // as below, by one look
  const float before_m = Clearance(w, cell, from);
  const float least_m = std::min(radius_m - kTolerance_m, before_m), out_m = std::min(radius_m, before_m + kComesOff_m);
  const float asked_m = Length(to - from);
  Vec2 p = to;
  for (int slide = 0; slide < kSlides; ++slide) {
    const Vec2 pushed = PushOut(w, cell, p, out_m);
    if (pushed.x == p.x && pushed.y == p.y) break;
    p = pushed;
  }
  for (int attempt = 0; attempt < 4; ++attempt) {  // shorter and shorter, else stay
    const float got_m = Length(p - from);
    if (got_m > asked_m && got_m > 1e-9f) p = from + (p - from) * (asked_m / got_m);
    if (Clearance(w, cell, p) >= least_m && grounded(p)) return p;
    p = from + (p - from) * 0.5f;
  }
  return from;
}

}  // namespace

Vec2 NearestOnSegment(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 ab = b - a;
  const float length2 = Dot(ab, ab);
  const float t = length2 > 0 ? std::clamp(Dot(p - a, ab) / length2, 0.0f, 1.0f) : 0.0f;
  return a + ab * t;
}

float Clearance(const Walkable& w, int cell, Vec2 p) {
  float nearest_m = 1e9f;
  VisitWalls(w, cell, p, [&](Vec2, float distance_m) { nearest_m = std::min(nearest_m, distance_m); });
  return nearest_m;
}

Vec2 PushedOff(const Walkable& w, int cell, Vec2 p, float radius_m) {
  return PushedBy([&](Vec2 now) { return PushOut(w, cell, now, radius_m); }, p);
}

void NearEdges::LookAt(const Walkable& w, int cell) {
  if (w_ == &w && cell_ == cell) return;
  w_ = &w;
  cell_ = cell;
  const size_t k = static_cast<size_t>(cell);
  const int first = w.wall_start[k], count = w.wall_start[k + 1] - first;
  fours_.assign(static_cast<size_t>(count + 3) / 4, {});
  for (int i = 0; i < count; ++i) {
    const Walkable::Edge& e = w.edges[static_cast<size_t>(w.wall_edges[static_cast<size_t>(first + i)])];
    const Vec2 ab = e.b - e.a;
    const float length2 = Dot(ab, ab);
    Four& four = fours_[static_cast<size_t>(i / 4)];
    const int lane = i % 4;
    four.edges[lane] = &e;
    four.ax[lane] = e.a.x;
    four.ay[lane] = e.a.y;
    four.along_x[lane] = ab.x;
    four.along_y[lane] = ab.y;
    four.per_length2[lane] = length2 > 0 ? 1 / length2 : 0;
  }
}

bool NearEdges::Reaches(const Four& four, Vec2 p, float reach_m2) {
  const Lanes x = p.x - four.ax, y = p.y - four.ay;
  Lanes t = (x * four.along_x + y * four.along_y) * four.per_length2;
  t = t < 0 ? Lanes{} : t;
  t = t > 1 ? Lanes{1, 1, 1, 1} : t;
  const Lanes away_x = x - t * four.along_x, away_y = y - t * four.along_y;
  const auto near = away_x * away_x + away_y * away_y < reach_m2;
  return (near[0] | near[1] | near[2] | near[3]) != 0;
}

Vec2 NearEdges::PushedOff(Vec2 p, float radius_m) const {
  const float reach_m2 = radius_m * radius_m * 1.01f;  // more than rounding makes of it
  return PushedBy(
      [&](Vec2 now) {
        for (const Four& four : fours_) {
          if (!Reaches(four, now, reach_m2)) continue;
          for (const Walkable::Edge* e : four.edges) {
            if (e != nullptr) PushOutOfEdge(*e, radius_m, &now);
          }
        }
        PushOutOfCircles(*w_, cell_, radius_m, &now);
        return now;
      },
      p);
}

Vec2 AwayFromNearest(const Walkable& w, int cell, Vec2 p) {
  Vec2 nearest;
  float nearest_m = 1e9f;
  VisitWalls(w, cell, p, [&](Vec2 away, float distance_m) {
    if (distance_m < nearest_m) nearest = away, nearest_m = distance_m;
  });
  return nearest;
}

bool HasWallsOnEitherSide(const Walkable& w, int cell, Vec2 p, float reach_m) {
  struct Wall {
    Vec2 away;
    float distance_m;
  };
  std::vector<Wall> near;
  bool found = false;
  VisitWalls(w, cell, p, [&](Vec2 away, float distance_m) {
    if (found || distance_m > reach_m || distance_m < 1e-4f) return;
    found = std::any_of(near.begin(), near.end(), [&](const Wall& other) {
      return Dot(away, other.away) < -kOpposite * distance_m * other.distance_m;
    });
    near.push_back({away, distance_m});
  });
  return found;
}

Vec2 AlongToDoor(const Walkable& w, Vec2 p, float radius_m, Vec2 way) {
  constexpr float kTouching_m = 0.03f, kInto = 0.8f, kFarthest_m = 0.6f, kStep_m = 0.05f, kThrough_m = 0.3f;
  const int cell = CellAt(w, p);
  if (cell < 0 || ClearAround_m(w, cell) > radius_m + kTouching_m) return way;
  const Vec2 away = AwayFromNearest(w, cell, p);
  const float away_m = Length(away);
  if (away_m < 1e-4f || away_m > radius_m + kTouching_m || Dot(way, away) > -kInto * away_m) return way;
  Vec2 along{-away.y / away_m, away.x / away_m};
  if (Dot(along, way) < 0) along = along * -1;
  const auto fits = [&](float aside_m) {
    const Vec2 beyond = p + along * aside_m + way * kThrough_m;
    const int there = CellAt(w, beyond);
    const Vec2 pushed = there >= 0 ? PushedOff(w, there, beyond, radius_m) : p;
    return Dot(pushed - p, way) > 0.7f * kThrough_m && Length(pushed - beyond) < 2 * kStep_m &&
           Clearance(w, there, pushed) > radius_m - 1e-3f;
  };
  for (float aside_m = kStep_m; aside_m < kFarthest_m; aside_m += kStep_m) {
    if (fits(aside_m)) return along;
    if (fits(-aside_m)) return along * -1;
  }
  return way;
}

Vec2 KeepOffWalls(const Walkable& w, Vec2 from, Vec2 to, float radius_m) {
  const float way_m = Length(to - from);
  if (ClearAround_m(w, CellAt(w, from)) >= radius_m + way_m) return to;
  const int pieces = std::max(1, static_cast<int>(std::ceil(way_m / (0.5f * radius_m))));
  Vec2 p = from;
  for (int k = 1; k <= pieces; ++k) {
    const Vec2 piece = (to - from) * (1 / static_cast<float>(pieces));
    p = ShortStep(w, p, p + piece, radius_m);
  }
  return p;
}

float RoomAlong_m(const Walkable& w, Vec2 p, Vec2 out, float radius_m, float most_m) {
  constexpr float kStep_m = 0.05f;
  float room_m = 0;
  const auto fits = [&](Vec2 at) {
    const int cell = CellAt(w, at);
    return cell >= 0 && OnGround(w, at) && (ClearAround_m(w, cell) >= radius_m || Clearance(w, cell, at) >= radius_m);
  };
  while (room_m < most_m && fits(p + out * (room_m + kStep_m))) room_m += kStep_m;
  return room_m;
}

Vec2 WallPush(const Walkable& w, Vec2 p, float radius_m) {
  const int cell = CellAt(w, p);
  if (cell < 0 || ClearAround_m(w, cell) >= radius_m + kWallComfort_m || NothingNear(w, cell)) return {};
  Vec2 push;
  VisitWalls(w, cell, p, [&](Vec2 away, float distance_m) {
    const float gap_m = distance_m - radius_m;
    if (gap_m < kWallComfort_m && distance_m > 1e-4f) {
      push = push + away * (kWallPush_mps2 * (1 - std::max(gap_m, 0.0f) / kWallComfort_m) / distance_m);
    }
  });
  const float length = Length(push);
  return length > kWallPush_mps2 ? push * (kWallPush_mps2 / length) : push;
}

}  // namespace flaneur
