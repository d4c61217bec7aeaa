// Obstacles from a town model: what keeps a person on foot from standing somewhere.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "pipeline/core/footprint.h"
#include "pipeline/core/scene.h"
#include "runtime/base/error.h"

namespace flaneur {

struct FootprintOptions {
  double clearance_m = 0.05;               // obstacles are enlarged by this, >= 0
  std::array<double, 2> band_m{0.1, 2.0};  // height over the local ground that blocks, 0 <= low < high
  double tolerance_m = 0.01;               // simplification moves a boundary outwards by at most this, >= 0
  double bridge_m = 0.05;                  // walls that miss each other by less close, >= 0
  double open_yard_m2 = 0.5;               // smaller enclosed yards are filled, >= 0
  double scale = 1;                        // metres per unit of the scene, > 0
  bool merge_blocks = false;               // houses that adjoin become one obstacle
  int threads = 0;                         // 0: one a core; the result is the same
};

struct FootprintStats {
  int objects = 0;    // buildings, walls, trees, ... found in the scene
  int triangles = 0;  // theirs
  int lines = 0;      // wall lines in the band
  int obstacles = 0;
  double covered_m2 = 0;       // without circles
  std::string doubt_of_units;  // why the scene's units seem to be no metres; empty: they do not
  std::vector<std::string>
      open_shells;  // buildings whose walls do not close, or had to be closed: the obstacle is a guess
};

// What reaches into the band over the ground below it blocks. Eaves and storeys above the band do not; arcades and
// passages stay open; what the walls of a building, or of houses that adjoin, enclose is solid where something is
// overhead and a hole where it is open to the sky. Trees and lamps become circles. Outer rings are anticlockwise, holes
// clockwise, all simple; names are unique; obstacles do not overlap but where houses themselves do, wider than 1.5 m. A
// town without ground has that which its buildings' foundations or feet tell. Holes of a few triangles in a building's
// shell are closed. Independent of the order of triangles and of the number of threads. `warnings` gets one line for
// each object that leaves nothing in the band, and one where the units seem to be no metres. Errors: an option out of
// range, a scene without anything in it, an object or ground wider than 100 km.
Error ExtractFootprints(const Scene& scene, const FootprintOptions& options, Footprints* footprints,
                        FootprintStats* stats = nullptr, std::vector<std::string>* warnings = nullptr);

}  // namespace flaneur
