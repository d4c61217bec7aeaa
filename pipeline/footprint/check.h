// Is this set of obstacles fit for a crowd? Every finding has a number, a place and an advice.
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/footprint.h"
#include "pipeline/core/scene.h"
#include "pipeline/footprint/findings.h"
#include "runtime/base/error.h"

namespace flaneur {

// Where people come in or leave. `ahead` (unit, or zero) leads from a door into the open.
struct Gate { std::string name; Point2 at_m; Point2 ahead; bool is_exit = false; };

struct CheckOptions {
  double clearance_m = -1;          // walls to obstacle boundary; negative: the collection's own
  double tolerance_m = 0.01;        // > 0
  double person_radius_m = 0.3;     // > 0
  int most_points = 256;            // in a ring
  double least_area_m2 = 0.01;
  double largest_coordinate_m = 1e6;
  double scale = 1;                 // of the town, as in FootprintOptions
  std::vector<Gate> gates;          // besides the town's own doors and exits
  std::vector<std::vector<int>> open_rings;  // by obstacle, as ReadGeoJson gives them; may be empty
};

// Looks at rings and pairs of obstacles; with a town also at walls, passages, ground, doors and exits. Independent
// findings are all reported, consequences of one fault are not; sorted by code, then by obstacle.
// Errors: an option out of range, a town without anything in it.
Error Check(const Footprints& footprints, const Scene* town, const CheckOptions& options,
            std::vector<Finding>* findings);

// The doors and exits of a town by the town convention.
std::vector<Gate> GatesOf(const Scene& town, double scale);

}  // namespace flaneur
