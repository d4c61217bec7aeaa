// The way to one destination from everywhere: Dijkstra distances over the navigation grid, shared by all who go there.
#pragma once
#include <vector>

#include "runtime/crowd/walkable.h"

namespace flaneur {

struct FlowField {
  Vec2 goal;
  std::vector<float> distance;  // weighted metres; infinity where there is no way
};

// Slopes cost more: a metre up or down a gradient g counts 1 + 4 |g|, near the energy of walking on gentle slopes
// (Minetti et al. 2002). The goal's nearest free cell within 3 m is the destination.
FlowField BuildFlowField(const Walkable& w, Vec2 goal);

bool Reachable(const Walkable& w, const FlowField& field, Vec2 from);

// A point to walk straight to: the farthest of the next cells on the best way that can be seen from p, or the goal.
Vec2 Waypoint(const Walkable& w, const FlowField& field, Vec2 p);

}  // namespace flaneur
