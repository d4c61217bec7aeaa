// Decimation of a skinned surface by edge collapses, cheapest first. What is left of an edge stands
// where its quadric error is least over all poses at once, with the weights that fit there.
#pragma once
#include <memory>
#include <vector>

#include "pipeline/avatar/wedge_surface.h"
#include "pipeline/core/mesh.h"
#include "runtime/base/jobs.h"
#include "runtime/base/math.h"

namespace flaneur {

class QuadricDecimater {
 public:
  // `poses`: skinning matrices that the error is summed over, besides the bind pose.
  QuadricDecimater(const std::vector<Mesh>& meshes, const std::vector<std::vector<Mat4>>& poses, Jobs* jobs = nullptr);
  ~QuadricDecimater();

  int Triangles() const;

  // Collapses edges until `triangles` are left. First the surface keeps its topology and no face
  // turns over; where that ends, closed parts may fall flat and vanish.
  void DecimateTo(int triangles);

  // What is left: vertices of the original that still have a face, and new ones.
  WedgeSurface Surface() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flaneur
