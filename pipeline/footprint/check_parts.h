// The parts of the check, one file each; see check.h.
#pragma once
#include <vector>

#include "pipeline/footprint/check.h"
#include "pipeline/footprint/polygon_sets.h"

namespace flaneur {

struct CheckedObstacle {
  const Obstacle* obstacle = nullptr;
  bool sound = false;  // its rings can be reckoned with
  Rings rings;         // as area; circles as 32-gons
  Point2 min, max;
};

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

void CheckRings(CheckState* state);                       // 101-203; fills sound and rings
void CheckPairs(CheckState* state);                       // 401-404
Error CheckAgainstTown(const Scene& town, CheckState* state);  // 301-307
Error CheckWays(const Scene* town, CheckState* state);    // 501, 601-604

}  // namespace flaneur
