// A straight corridor of 30 m whose ends are one (periodic), between two walls. The ends are joined by doubles:
// everybody has one, 30 m before or behind, that moves as they do. Shared by tests.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/base/random.h"
#include "runtime/crowd/crowd.h"

namespace flaneur {

inline constexpr float kCorridorStep_s = 1.0f / 30, kCorridorLength_m = 30, kCorridorFree_mps = 1.34f;

struct Corridor {
  Walkable walkable;
  Crowd crowd;  // the people, then their doubles
  CrowdScratch scratch;
  size_t people = 0;
  float width_m = 0;
};

// People live in x 0 ... 30; walls at y 0 and width_m. The goals lie so far beyond that everybody walks along the
// corridor.
inline Walkable CorridorGround(float width_m) {
  Walkable w;
  const int columns = 320, rows = static_cast<int>(2 * width_m);
  const size_t all = static_cast<size_t>(columns * rows);
  w.ground = Share({{-65, 0}, 0.5f, columns, rows, std::vector<float>(all, 0), std::vector<uint8_t>(all, 3)});
  w.polygons.push_back({{{-70, -1}, {100, -1}, {100, 0}, {-70, 0}}, {}});
  w.polygons.push_back({{{-70, width_m}, {100, width_m}, {100, width_m + 1}, {-70, width_m + 1}}, {}});
  BuildWalkable(0.26f, &w, 0.25f);
  return w;
}

inline void JoinEnds(Corridor* corridor) {
  Crowd& c = corridor->crowd;
  for (size_t i = 0; i < corridor->people; ++i) {
    float& x_m = c.position[i].x;
    x_m += x_m >= kCorridorLength_m ? -kCorridorLength_m : x_m < 0 ? kCorridorLength_m : 0;
    const size_t other = corridor->people + i;
    c.position[other] = c.position[i] + Vec2{x_m < kCorridorLength_m / 2 ? kCorridorLength_m : -kCorridorLength_m, 0};
    c.velocity[other] = c.velocity[i];
    c.heading_rad[other] = c.heading_rad[i];
  }
}

// On a lattice with some disorder (random places don't fit where it is dense); this share of the people, drawn at
// random, walk west.
inline Corridor MakeCorridor(float width_m, float density_pm2, float share_west, uint64_t seed) {
  Corridor corridor{CorridorGround(width_m), {}, {}, 0, width_m};
  Crowd& c = corridor.crowd;
  Random random{seed};
  const float y_m = width_m / 2, margin_m = 0.27f;
  const int east = FieldFor({90, y_m}, &c), west = FieldFor({-60, y_m}, &c);
  const int people = static_cast<int>(std::lround(density_pm2 * kCorridorLength_m * width_m));
  const int fit = static_cast<int>((width_m - 2 * margin_m) / 0.55f) + 1;
  const int even = static_cast<int>(std::round(std::sqrt(static_cast<float>(people) * width_m / kCorridorLength_m)));
  const int rows = std::clamp(even, 2, fit), columns = (people + rows - 1) / rows;
  const float pitch_m = kCorridorLength_m / static_cast<float>(columns),
              jitter_m = 0.3f * std::max(0.0f, pitch_m - 0.5f);
  for (int k = 0; k < people; ++k) {
    const int row = k % rows, column = k / rows;
    Person p;
    p.position = {
        (static_cast<float>(column) + 0.25f + (row % 2 ? 0.5f : 0)) * pitch_m + random.Uniform(-jitter_m, jitter_m),
        margin_m + static_cast<float>(row) * (width_m - 2 * margin_m) / static_cast<float>(rows - 1)};
    p.preferred_mps = kCorridorFree_mps;
    const bool goes_west = share_west > 0 && random.Uniform() < share_west;
    p.field = goes_west ? west : east;
    p.heading_rad = goes_west ? kPi : 0;
    AddPerson(p, &c);
  }
  corridor.people = c.size();
  for (size_t k = 0; k < corridor.people; ++k) {
    Person p;
    p.position = c.position[k];
    p.heading_rad = c.heading_rad[k];
    p.preferred_mps = kCorridorFree_mps;
    p.field = c.field[k];
    AddPerson(p, &c);
  }
  for (ViewClass& view : c.view) view = ViewClass::kVisible;
  JoinEnds(&corridor);
  return corridor;
}

inline void StepCorridor(const std::vector<MovingObstacle>& moving, Corridor* corridor) {
  StepCrowd(corridor->walkable, moving, kCorridorStep_s, &corridor->scratch, &corridor->crowd);
  JoinEnds(corridor);
}

// How fast the people get along the corridor in the way they want, mean over all.
inline float SpeedAlong_mps(const Corridor& corridor) {
  const Crowd& c = corridor.crowd;
  float sum_mps = 0;
  for (size_t i = 0; i < corridor.people; ++i) {
    sum_mps += c.fields[static_cast<size_t>(c.field[i])].goal.x > 0 ? c.velocity[i].x : -c.velocity[i].x;
  }
  return sum_mps / static_cast<float>(corridor.people);
}

}  // namespace flaneur
