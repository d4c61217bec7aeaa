// Tells passages under buildings (arcades, gateways) from other free ground.
#pragma once
#include <optional>
#include <vector>

#include "pipeline/core/footprint.h"
#include "pipeline/footprint/overhead.h"
#include "pipeline/footprint/polygon_sets.h"
#include "pipeline/footprint/rasterize_ground.h"
#include "pipeline/footprint/town_objects.h"

namespace flaneur {

struct PassageParts {
  double passage_m2 = 0, elsewhere_m2 = 0;
  Point2 passage_at, elsewhere_at;
};

class PassageTest {
 public:
  struct Options {
    double headroom_m = 2, person_radius_m = 0.3;
    double slack_m = 0.012;  // what the area lacks at its sides
    double ends_m = 0.1;     // what lies this far before a passage belongs to it
  };
  // `town` must outlive the test.
  PassageTest(const TownObjects& town, const GroundRaster& raster, const Options& options);

  static constexpr double kFarthestWall_m = 8;  // beside a place under a roof

  // Splits free ground that an obstacle covers. A passage is roofed with headroom, wide enough for a person, and has
  // walls or pillars on two opposite sides, among `walls`: so ground under eaves is none.
  PassageParts Sort(const Rings& area, const Rings& walls) const;

 private:
  struct Samples {
    std::vector<Point2> roofed, open;
    std::vector<Point2> candidates;  // roofed, and far enough from the area's boundary to walk there
  };
  bool Roofed(Point2 p) const;
  Samples Sample(const Rings& area, const Rings& walkable, double step_m) const;
  bool BetweenWalls(Point2 p, const AreaIndex& walls) const;
  std::optional<Point2> FirstBetweenWalls(const std::vector<Point2>& candidates, const AreaIndex& walls) const;

  Options options_;
  LocalGround ground_;
  Overhead overhead_;
};

}  // namespace flaneur
