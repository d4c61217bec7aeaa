// The walkable surface of a town as a raster.
#pragma once
#include <utility>

#include "pipeline/core/footprint.h"
#include "pipeline/core/scene.h"
#include "pipeline/footprint/town_objects.h"
#include "runtime/base/error.h"

namespace flaneur {

struct GroundRasterOptions {
  double cell_m = 0.25;       // > 0; doubled until the raster holds at most max_cells
  int max_cells = 4'000'000;  // > 0
  double scale = 1;           // metres per unit of the scene, > 0
  double bare_margin_m = 10;  // a town without ground gets a flat square this far round it
  bool with_decks = true;     // of bridges, where the ground leads on to them
};

// Each cell takes the topmost ground triangle over its centre; cracks of up to half a metre are ground. A town without
// any ground stands on a square that joins the feet of its buildings. Errors: an option out of range, nothing in the
// scene, a town wider than 100 km (names the extent).
Error RasterizeGround(const Scene& scene, const GroundRasterOptions& options, GroundRaster* raster);
Error RasterizeGround(const TownObjects& town, const GroundRasterOptions& options, GroundRaster* raster);

// Carries every cell without ground the height of a near one with ground.
void FillGaps(GroundRaster* raster);

// The height of the ground everywhere: between cell centres bilinear except across steps, where there is no ground that
// of the nearest ground, smoothed if so asked. The raster must have at least one cell of ground.
class LocalGround {
 public:
  enum class Gaps { kNearest, kSmooth };
  explicit LocalGround(const GroundRaster& raster, Gaps gaps = Gaps::kSmooth);
  double Height(double x, double y) const;
  // The least and the greatest height that Height may give in a box.
  std::pair<double, double> Range(Point2 min, Point2 max) const;
  double min_height() const { return min_height_; }
  double max_height() const { return max_height_; }

 private:
  GroundRaster raster_;  // filled: every cell has a height
  double min_height_ = 0, max_height_ = 0;
};

}  // namespace flaneur
