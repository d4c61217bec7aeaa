// The parts of the check, one file each; see check.h.
#pragma once
#include <vector>

#include "pipeline/footprint/box_grid.h"
#include "pipeline/footprint/check.h"
#include "pipeline/footprint/polygon_sets.h"

namespace flaneur {

struct CheckedObstacle {
  const Obstacle* obstacle = nullptr;
  Rings rings;        // its area as well as it can be told, without spikes; circles as polygons; empty: no telling
  Rings spikes;       // what was taken off
  Rings doubt;        // convex, one a crossing: where a broken ring leaves open what is inside
  bool sound = true;  // none of 101 to 202
  bool points_missing = false;  // of the outer ring: its edges mean little
  bool holes_broken = false;
  bool duplicate = false;  // of an earlier one
  Point2 min, max;
};

// What stands near a place; obstacles without rings are not in it.
BoxGrid GridOf(const std::vector<CheckedObstacle>& obstacles);

struct CheckState {
  const Footprints& footprints;
  const CheckOptions& options;
  double clearance_m;
  std::vector<CheckedObstacle> obstacles;
  std::vector<Finding>* findings;
  void Add(int code, const std::string& feature, Point2 at, double value, double limit, const std::string& detail,
           const std::string& other = {});
};

std::string Metres(double value);  // "0.12 m"
std::string SquareMetres(double value);

Ring CircleRing(Point2 center, double radius_m);

// Grown by distance_m with round corners, shrunk where negative.
Rings OffsetRound(const Rings& rings, double distance_m);
// What a ring encloses, however it winds.
Rings NonZeroArea(const Ring& ring);
Ring ConvexHull(Ring points);

void CheckRings(CheckState* state);                                  // 101-203; fills the obstacles
void CheckPairs(CheckState* state);                                  // 401-404
void CheckAgainstTown(const PreparedTown& town, CheckState* state);  // 301-307, 907
Error CheckWays(const PreparedTown* town, CheckState* state);        // 501-503, 601-604
void CheckStreets(CheckState* state);                                // 504

}  // namespace flaneur
