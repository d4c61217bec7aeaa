// Turns the normals, mixes the vertex colours and shifts the pictures of a decimated surface so that it looks, between
// its corners, as the original does there: least squares over points of the level, each tied to the nearest place of
// the original that faces the same way.
#pragma once
#include <vector>

#include "pipeline/avatar/wedge_surface.h"
#include "pipeline/core/mesh.h"
#include "runtime/base/jobs.h"

namespace flaneur {

struct LookOptions {
  int samples = 40000;  // of the level at most; seven a face are enough
  int rounds = 24;      // of solving
  Jobs* jobs = nullptr;
};

struct LookOriginal;
struct ChartBounds {
  Vec2 min{1e30f, 1e30f}, max{-1e30f, -1e30f};
};  // uvs

// Keeps what all levels of one original, which must outlive this, have in common.
class LookFitter {
 public:
  explicit LookFitter(const std::vector<Mesh>& original, const LookOptions& options = {});
  ~LookFitter();

  // In the bind pose. Wedges that meet in one vertex with the same normal, colour or uv keep one in common; uvs stay
  // within the bounds of the original's part that they belong to. A level with more than half as many faces as samples
  // stays as it is.
  void Fit(WedgeSurface* level) const;

 private:
  LookOptions options_;
  std::vector<LookOriginal> originals_;  // one a mesh
  std::vector<ChartBounds> bounds_;      // by chart
  bool colored_ = false;                 // some mesh has colours at its vertices
};

}  // namespace flaneur
