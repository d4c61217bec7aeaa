// What the checks of ways share; see check_parts.h.
#pragma once
#include <string>
#include <vector>

#include "pipeline/footprint/check_parts.h"
#include "pipeline/footprint/way_network.h"

namespace flaneur {

// Obstacles, and where they are.
struct Placed {
  const std::vector<CheckedObstacle>& obstacles;
  BoxGrid grid;
  explicit Placed(const std::vector<CheckedObstacle>& all) : obstacles(all), grid(GridOf(all)) {}
};
// The distance to the nearest one, and which; null where there are none. `inside`: of one of them.
double NearestObstacle(const Placed& placed, Point2 p, const CheckedObstacle** nearest, bool* inside);
// Its name; empty where there are none.
std::string NearestName(const Placed& placed, Point2 p);

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
                  const BrokenPlaces& broken, const Placed& placed, CheckState* state);

}  // namespace flaneur
