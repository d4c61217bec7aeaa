// Levels of detail of a person: OpenMesh's quadric decimation (Garland and Heckbert 1997) by
// half-edge collapses.
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"
#include "runtime/base/error.h"

namespace flaneur {

struct LevelsOptions {
  std::vector<float> ratios{1.0f, 0.5f, 0.25f,
                            0.1f};  // of the original's triangles, falling, in (0, 1]
  int max_triangles = 0;            // of level 0; 0: no limit
  int min_triangles = 200;          // no level has fewer, unless the original has
  int error_samples =
      4000;            // points per surface that the deviation is measured at, besides the vertices
  int walk_poses = 8;  // that posed_error_mm is measured over
};

// Reduces the avatar step by step by half-edge collapses, so that every vertex of a level stands
// where one of the original stands and has its weights. Borders between materials, uv seams and
// open edges keep their line; where a corner must leave its seam it keeps its uv. Every level has
// its target of triangles within 2 % or a warning says why. Errors: no triangles, ratios out of
// order or range, a non-finite position (names the mesh and vertex).
Error BuildLevels(const Avatar& avatar, const LevelsOptions& options, AvatarLevels* levels,
                  std::vector<std::string>* warnings);

}  // namespace flaneur
