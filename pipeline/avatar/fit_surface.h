// Moves the vertices of a decimated surface, and turns their weights, so that it lies as near as it
// can to the original in all poses (after Hoppe and others 1993, Mesh Optimization: points of the
// original, each tied to the nearest place of the level, and least squares).
#pragma once
#include <memory>
#include <vector>

#include "pipeline/avatar/wedge_surface.h"
#include "pipeline/core/mesh.h"
#include "runtime/base/jobs.h"
#include "runtime/base/math.h"

namespace flaneur {

struct FitOriginal;

// Keeps what all levels of one original have in common.
class SurfaceFitter {
 public:
  // `poses`: skinning matrices, besides the bind pose; they must outlive this.
  SurfaceFitter(const std::vector<Mesh>& original, const std::vector<std::vector<Mat4>>& poses, Jobs* jobs = nullptr);
  ~SurfaceFitter();

  // Faces, wedges and joints of a vertex stay; no face turns over, and none is pulled farther than
  // the surfaces are apart. A level of more than 10,000 faces stays as it is.
  void Fit(WedgeSurface* level) const;

 private:
  std::unique_ptr<FitOriginal> original_;
};

}  // namespace flaneur
