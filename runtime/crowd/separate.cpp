// Separation in the boundary: nobody sees it, so it happens at once.
#include <algorithm>
#include <cmath>

#include "runtime/crowd/constants.h"
#include "runtime/crowd/crowd.h"
#include "runtime/crowd/walls.h"

namespace flaneur {
namespace {

constexpr float kRing_m = 0.12f;
constexpr int kRings = 40;           // up to 5 m away
constexpr float kTouching_m = 1e-3f; // overlaps smaller than this are none

struct Spot {
  const Walkable* w;
  bool (*keep_out)(Vec2, const void*);
  const void* volume;
  float most_radius_m;
};

bool Touches(const Crowd& c, size_t i, Vec2 p, size_t j) {
  const Vec2 apart = p - c.position[j];
  const float reach_m = c.radius_m[i] + c.radius_m[j] - kTouching_m;
  return j != i && Dot(apart, apart) < reach_m * reach_m;
}

bool Overlaps(const Spot& s, const Crowd& c, size_t i, Vec2 p) {
  for (int j : c.displaced) {  // no longer where the grid has them
    if (Touches(c, i, p, static_cast<size_t>(j))) return true;
  }
  bool any = false;
  VisitNear(c.neighbours, p, c.radius_m[i] + s.most_radius_m,
            [&](const Neighbour& other) { any = any || Touches(c, i, p, static_cast<size_t>(other.person)); });
  return any;
}

// Fits there without touching anything, on the same side of all walls.
bool Fits(const Spot& s, const Crowd& c, size_t i, Vec2 p) {
  if (s.keep_out(p, s.volume) || !IsFree(*s.w, p) || Overlaps(s, c, i, p)) return false;
  const int there = CellAt(*s.w, p), here = NearestFreeCell(*s.w, c.position[i], 1.0f);
  return here >= 0 && s.w->component[static_cast<size_t>(there)] == s.w->component[static_cast<size_t>(here)] &&
         Clearance(*s.w, there, p) >= c.radius_m[i];
}

}  // namespace

void SeparateBoundary(const Walkable& w, bool (*keep_out)(Vec2, const void*), const void* volume, Crowd* c) {
  Spot spot{&w, keep_out, volume, 0};
  c->displaced.clear();
  c->caring.clear();
  for (size_t i = 0; i < c->size(); ++i) {
    if (c->view[i] != ViewClass::kOutside) c->caring.push_back(static_cast<int>(i));
    spot.most_radius_m = std::max(spot.most_radius_m, c->radius_m[i]);
  }
  SortIntoGrid(c->caring, c->position, c->velocity, c->radius_m, kNeighbourRadius_m / 2, &c->neighbours);
  for (int who : c->caring) {
    const size_t i = static_cast<size_t>(who);
    if (c->view[i] != ViewClass::kBoundary || c->was_visible[i] || !Overlaps(spot, *c, i, c->position[i])) continue;
    bool placed = false;
    for (int ring = 1; ring <= kRings && !placed; ++ring) {  // the nearest free spot on growing rings
      const float reach_m = kRing_m * static_cast<float>(ring);
      const int spots = 8 + 4 * ring;
      for (int k = 0; k < spots && !placed; ++k) {
        const float angle = 2 * kPi * static_cast<float>(k) / static_cast<float>(spots);
        const Vec2 p = c->position[i] + Vec2{std::cos(angle), std::sin(angle)} * reach_m;
        placed = Fits(spot, *c, i, p);
        if (!placed) continue;
        c->position[i] = p;
        c->displaced.push_back(static_cast<int>(i));
      }
    }
  }
}

}  // namespace flaneur
