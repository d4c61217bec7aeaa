// Is this set of obstacles fit for a crowd? Every finding has a number, a place and an advice.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "pipeline/core/footprint.h"
#include "pipeline/core/scene.h"
#include "pipeline/footprint/findings.h"
#include "pipeline/footprint/town_objects.h"
#include "runtime/base/error.h"

namespace flaneur {

// Where people come in or leave. `ahead` (unit, or zero) leads from a door into the open.
struct Gate {
  std::string name;
  Point2 at_m;
  Point2 ahead;
  bool is_exit = false;
};

// The middle of a street.
struct Centreline {
  std::string name;
  std::vector<Point2> points_m;
};

struct CheckOptions {
  double clearance_m = -1;               // walls to obstacle boundary; negative: the collection's own
  double tolerance_m = 0.01;             // > 0; distances may be off by this
  double person_radius_m = 0.3;          // > 0
  double same_point_m = 0.001;           // > 0; 102: neighbours in a ring that are nearer
  double least_area_m2 = 0.01;           // >= 0; 106, and of a hole outside its ring or on another hole: 201, 202
  double largest_coordinate_m = 1e6;     // > 0; 107
  int most_points = 256;                 // >= 3; 108, in a ring
  double spike_width_m = 0.01;           // > 0; 203: what an opening with this radius takes away,
  double spike_length_m = 0.1;           // > 0; where it is longer than this
  double over_cover_share = 0.02;        // >= 0; 303: of a footprint's area
  double headroom_m = 2;                 // > 0; 307
  double overlap_m2 = 0.01;              // >= 0; 401
  double least_ground_m2 = 1;            // > 0; 501
  double dead_end_m = 10;                // > 0; 502: deeper
  double high_resolution_radius_m = 10;  // > 0; 503: round the visitor
  double scale = 1;                      // of the town, as in FootprintOptions
  int threads = 0;                       // 0: one a core; the result is the same
  std::vector<Gate> gates;               // besides the town's own doors and exits
  std::vector<Centreline> streets;
  std::vector<std::vector<int>> open_rings;  // by obstacle, as ReadGeoJson gives them; may be empty
};

// The name and value of each number above that must be greater than zero, or at least zero: for messages and for
// options of a program.
struct CheckNumber {
  const char* name;
  const char* help;
  double CheckOptions::*value;
  bool may_be_zero;
};
const std::vector<CheckNumber>& CheckNumbers();
// Errors: an option out of range (names it).
Error Validate(const CheckOptions& options);

// A town made ready to be compared with obstacles.
struct PreparedTown {
  const Scene* scene = nullptr;  // must outlive it
  TownObjects objects;
  std::vector<std::vector<size_t>> adjoining;  // of a town without terrain: which obstacles adjoin each
  Footprints own;  // what the extraction makes of it, with the obstacles' clearance and band
  std::vector<std::string> open_shells;
  GroundRaster ground;
  // The ground without bridges' decks, over which the extraction cuts walls; none where it is the same.
  std::optional<GroundRaster> below_bridges;
};
// `footprints` is for its clearance and band. Errors: as for ExtractFootprints.
Error PrepareTown(const Scene& town, const Footprints& footprints, const CheckOptions& options, PreparedTown* prepared);

// Looks at rings and pairs of obstacles, at the ways between them and the streets; with a town also at walls, passages,
// ground, doors and exits. Independent findings are all reported, consequences of one fault are not; sorted by code,
// then by obstacle. Errors: as Validate, a town without anything in it.
Error Check(const Footprints& footprints, const Scene* town, const CheckOptions& options,
            std::vector<Finding>* findings);
// The same, with a town that is ready; null: without one.
Error CheckPrepared(const Footprints& footprints, const PreparedTown* town, const CheckOptions& options,
                    std::vector<Finding>* findings);

// The doors and exits of a town by the town convention.
std::vector<Gate> GatesOf(const Scene& town, double scale);

}  // namespace flaneur
