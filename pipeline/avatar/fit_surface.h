// Moves the vertices of a decimated surface, and turns their weights, so that it lies as near as it
// can to the original in all poses (after Hoppe and others 1993, Mesh Optimization: points of the
// original, each tied to the nearest place of the level, and least squares).
#pragma once
#include <memory>
#include <vector>

#include "pipeline/avatar/wedge_surface.h"
#include "pipeline/core/mesh.h"
#include "runtime/base/math.h"

namespace flaneur {

struct FitOptions {
  int samples = 20000;  // of each of the two surfaces at most; five a face are enough
  int rounds = 2;       // of tying and solving
};

struct FitOriginal;

// Keeps what all levels of one original have in common.
class SurfaceFitter {
 public:
  // `poses`: skinning matrices, besides the bind pose; they must outlive this.
  SurfaceFitter(const std::vector<Mesh>& original, const std::vector<std::vector<Mat4>>& poses,
                const FitOptions& options = {});
  ~SurfaceFitter();

  // Faces, wedges and joints of a vertex stay; no face turns over, and none is pulled farther than
  // the surfaces are apart. A level with more than half as many faces as samples stays as it is.
  void Fit(WedgeSurface* level) const;

 private:
  FitOptions options_;
  std::unique_ptr<FitOriginal> original_;
};

}  // namespace flaneur
