// How crowded the ground is, coarsely: whoever chooses where to go keeps clear of a crowd.
#pragma once
#include <vector>

#include "runtime/crowd/walkable.h"

namespace flaneur {

struct DensityMap {
  Vec2 min_m;
  float cell_m = 0, cells_per_m = 0;  // 0: not built yet
  int columns = 0, rows = 0;
  std::vector<float> per_person_pm2;  // by cell, 1 / its walkable area
  std::vector<float> density_pm2;     // people by walkable area
};

// Counts these people anew; allocates the first time only.
void CountPeople(const Walkable& w, const std::vector<Vec2>& position, DensityMap* map);

// In people a square metre; 0 before anybody was counted.
float DensityAt_pm2(const DensityMap& map, Vec2 p);
// The greatest on the straight line from p to q.
float MostDensityBetween_pm2(const DensityMap& map, Vec2 p, Vec2 q);

}  // namespace flaneur
