// What the checks of ways share; see check_parts.h.
#pragma once
#include <string>
#include <vector>

#include "pipeline/footprint/check_parts.h"
#include "pipeline/footprint/way_network.h"

namespace flaneur {

// Its name; empty where there are no obstacles.
std::string NearestObstacle(const std::vector<CheckedObstacle>& obstacles, Point2 p);

// Where obstacles have broken rings: what lies beside them may be other than it seems, and is not reported.
class BrokenPlaces {
 public:
  explicit BrokenPlaces(const CheckState& state);
  bool Near(Point2 p, double reach) const;

 private:
  struct Box {
    Point2 min, max;
  };
  std::vector<Box> boxes_;
};

// 502, 503 on ground without the obstacles. `state` is for its options and findings.
void CheckNetwork(const Rings& ground, const OpenTest& is_open, const std::vector<Gate>& gates,
                  const BrokenPlaces& broken, const std::vector<CheckedObstacle>& obstacles, CheckState* state);

}  // namespace flaneur
