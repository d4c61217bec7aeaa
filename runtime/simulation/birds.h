// Which birds are drawn, and how finely. They share people's triangle budget: what they take is people's no more.
// Internal to runtime/simulation and runtime/show.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "runtime/control/level_control.h"
#include "runtime/town/town.h"

namespace flaneur {

inline constexpr float kBirdReach_m = 80;        // farther ones are not drawn
inline constexpr float kBirdShadow_m = 30;       // farther ones cast no shadow
inline constexpr float kBirdBudgetShare = 0.1f;  // of people's triangles, that birds take at most

// By the distance alone, so that nothing is remembered: a mesh, and within a band before it ends the next coarser one
// too.
struct ShownBird {
  int flock = 0, bird = 0;  // indices into Town::flocks and its birds
  int mesh = 0;             // of its avatar
  float finer = 1;          // how much of that is seen; the rest is the next coarser one
  float share = 1;          // how much of the bird is seen
  bool casts_shadow = false;
};

struct BirdLevels {
  std::vector<ShownBird> shown;
  int64_t triangles = 0;  // of them, shadows included
  float reach_m = kBirdReach_m;
  std::vector<std::pair<float, int>> nearest;  // scratch: distance, triangles
};

// Those around the camera, nearest first, as far as their share of `budget_triangles` goes.
void ChooseBirds(const Town& town, const std::vector<AvatarCosts>& avatars, const LevelQuery& query, float eye_height_m,
                 float budget_triangles, float step_s, BirdLevels* birds);

}  // namespace flaneur
