// The middle lines of free ground as a graph: where people can walk, how wide it is, and what hangs on one way only.
#pragma once
#include <functional>
#include <vector>

#include "pipeline/footprint/polygon_sets.h"
#include "runtime/base/array.h"

namespace flaneur {

struct WayNode {
  Point2 at;
  double clearance_m = 0;  // to the nearest edge of the ground
  bool open = false;       // the nearest edge is where the map ends, and people may come and go
  std::vector<int> ways;   // into WayNetwork::ways
};

struct WayEdge {
  int from = 0, to = 0;
  double length_m = 0;
};

struct WayNetwork {
  std::vector<WayNode> nodes;
  std::vector<WayEdge> ways;
  int Other(int way, int node) const {
    const WayEdge& w = At(ways, way);
    return w.from == node ? w.to : w.from;
  }
};

// The Voronoi diagram of the boundary of `ground` (outer rings anticlockwise, holes clockwise), inside it, wherever the
// boundary is at least least_clearance_m away; without the branches that run into corners. `is_open` is asked for each
// edge of the boundary.
using OpenTest = std::function<bool(Point2 a, Point2 b)>;
WayNetwork BuildWayNetwork(const Rings& ground, double least_clearance_m, const OpenTest& is_open);

}  // namespace flaneur
