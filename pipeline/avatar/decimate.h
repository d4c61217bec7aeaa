// Levels of detail of a person: quadric decimation (Garland and Heckbert 1997) for all poses of the
// walk at once, each level then fitted to the original.
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"
#include "runtime/base/error.h"
#include "runtime/base/jobs.h"

namespace flaneur {

struct LevelsOptions {
  // Of the original's triangles, falling, in (0, 1]. Empty: the chain follows from the errors. It
  // has 1, 0.5, 0.4, 0.2, 0.1, 0.05, ... of the triangles without the levels that no size on screen
  // needs, and ends, from the third level on, where impostors are better, or where so few triangles save nothing.
  // Levels whose normals are more than 2.5 degrees off on average are shown below 128 px alone.
  std::vector<float> ratios;
  float error_px = 1;      // on the screen: that much of a level's error may show
  int max_triangles = 0;   // of level 0; 0: no limit
  int min_triangles = 16;  // no level has fewer, unless the original has
  // Points per surface that the deviation is measured at, besides its vertices.
  int error_samples = 3000;
  int walk_poses = 8;    // that posed_error_mm is measured over
  int max_joints = 256;  // that the player knows; of more those go that are least missed
  Jobs* jobs = nullptr;  // that share the work; the result is the same
};

// Reduces the avatar step by step by edge collapses: vertices move to where the error over bind
// pose and walk is least, with at most four weights that sum to 1. Borders between materials, uv
// seams and open edges keep their line; pictures are interpolated along collapsed edges. Every
// level has its target of triangles within 2 % or a warning says why. The same result on any number
// of threads. Joints that never move otherwise than their parents go; in coarser levels so do those
// whose own motion the level's error hides, and several materials become one (material_atlas.h).
// Errors: no triangles, ratios out of order or range, a non-finite position (names the
// mesh and vertex).
Error BuildLevels(const Avatar& source, const LevelsOptions& options, AvatarLevels* levels,
                  std::vector<std::string>* warnings);

}  // namespace flaneur
