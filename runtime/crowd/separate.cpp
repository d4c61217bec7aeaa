// Separation in the boundary: nobody sees it, so it happens at once.
#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/crowd/constants.h"
#include "runtime/crowd/crowd.h"
#include "runtime/crowd/walls.h"

namespace flaneur {
namespace {

constexpr float kRing_m = 0.12f;
constexpr int kRings = 40;            // up to 5 m away
constexpr float kTouching_m = 1e-3f;  // overlaps smaller than this are none

struct Spot {
  const Walkable* w;
  bool (*keep_out)(Vec2, float, const void*);
  const void* volume;
  const NeighbourGrid& neighbours;
  Displaced& displaced;
  float most_radius_m = 0;
};

bool Touches(const Crowd& c, size_t i, Vec2 p, size_t j) {
  const Vec2 apart = p - c.position[j];
  const float reach_m = c.radius_m[i] + c.radius_m[j] - kTouching_m;
  return j != i && Dot(apart, apart) < reach_m * reach_m;
}

bool OverlapsDisplaced(const Spot& s, const Crowd& c, size_t i, Vec2 p, float reach_m) {
  const CellRange near = CellsNear(s.neighbours, p, reach_m);
  for (int y = near.y0; y <= near.y1; ++y) {
    for (int x = near.x0; x <= near.x1; ++x) {
      int j = s.displaced.first[static_cast<size_t>(y * s.neighbours.columns + x)];
      for (; j >= 0; j = s.displaced.next[static_cast<size_t>(j)]) {
        if (Touches(c, i, p, static_cast<size_t>(j))) return true;
      }
    }
  }
  return false;
}

bool Overlaps(const Spot& s, const Crowd& c, size_t i, Vec2 p) {
  const float reach_m = c.radius_m[i] + s.most_radius_m;
  if (OverlapsDisplaced(s, c, i, p, reach_m)) return true;
  bool any = false;
  VisitNear(s.neighbours, p, reach_m,
            [&](const Neighbour& other) { any = any || Touches(c, i, p, static_cast<size_t>(other.person)); });
  return any;
}

// Fits there without touching anything, on the same side of all walls.
bool Fits(const Spot& s, const Crowd& c, size_t i, int component, Vec2 p) {
  if (s.keep_out(p, c.reach_m[i], s.volume) || !IsFree(*s.w, p)) return false;
  const int there = CellAt(*s.w, p);
  if (s.w->component[static_cast<size_t>(there)] != component || Overlaps(s, c, i, p)) return false;
  return Clearance(*s.w, there, p) >= c.radius_m[i];
}

// Offsets of the spots looked at, nearest first: rings that grow.
std::vector<Vec2> MakeRings() {
  std::vector<Vec2> offsets;
  for (int ring = 1; ring <= kRings; ++ring) {
    const float reach_m = kRing_m * static_cast<float>(ring);
    const int spots = 8 + 4 * ring;
    for (int k = 0; k < spots; ++k) {
      const float angle = 2 * kPi * static_cast<float>(k) / static_cast<float>(spots);
      offsets.push_back(Vec2{std::cos(angle), std::sin(angle)} * reach_m);
    }
  }
  return offsets;
}

const std::vector<Vec2> kOffsets = MakeRings();

void Displace(const Spot& s, size_t i, Crowd* c) {
  const int here = NearestFreeCell(*s.w, c->position[i], 1.0f);
  if (here < 0) return;
  const int component = s.w->component[static_cast<size_t>(here)];
  for (const Vec2 offset : kOffsets) {
    const Vec2 p = c->position[i] + offset;
    if (!Fits(s, *c, i, component, p)) continue;
    c->position[i] = p;
    int& first = s.displaced.first[static_cast<size_t>(CellOf(s.neighbours, p))];
    s.displaced.next[i] = first;
    first = static_cast<int>(i);
    s.displaced.people.push_back(first);
    return;
  }
}

}  // namespace

void SeparateBoundary(const Walkable& w, bool (*keep_out)(Vec2, float, const void*), const void* volume,
                      CrowdScratch* s, Crowd* c) {
  Spot spot{&w, keep_out, volume, s->neighbours, s->displaced};
  s->caring.clear();
  s->displaced.people.clear();
  for (size_t i = 0; i < c->size(); ++i) {
    if (c->view[i] != ViewClass::kOutside) s->caring.push_back(static_cast<int>(i));
    spot.most_radius_m = std::max(spot.most_radius_m, c->radius_m[i]);
  }
  SortIntoGrid(s->caring, c->position, c->velocity, c->radius_m, kGridCell_m, &s->neighbours);
  s->displaced.first.reserve(s->neighbours.start.capacity());
  s->displaced.first.assign(s->neighbours.start.size(), -1);
  s->displaced.next.resize(c->size());
  for (int who : s->caring) {
    const size_t i = static_cast<size_t>(who);
    if (c->view[i] != ViewClass::kBoundary || c->was_visible[i] || c->activity[i] == Activity::kWorking) continue;
    if (!Overlaps(spot, *c, i, c->position[i])) continue;
    Displace(spot, i, c);
  }
}

}  // namespace flaneur
