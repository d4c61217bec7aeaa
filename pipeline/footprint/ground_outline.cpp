#include "pipeline/footprint/ground_outline.h"

#include <array>
#include <cmath>
#include <vector>

#include "pipeline/footprint/constants.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

// The edges between ground and no ground, followed with the ground on the left.
class Tracer {
 public:
  explicit Tracer(const GroundRaster& raster) : raster_(raster), stride_(static_cast<size_t>(raster.columns) + 1) {}

  Rings Trace() {
    // Corner (column, row) is left east, north, west, south; a bit each.
    leaving_.assign(stride_ * (static_cast<size_t>(raster_.rows) + 1), 0);
    for (int row = 0; row < raster_.rows; ++row) {
      for (int column = 0; column < raster_.columns; ++column) {
        if (!IsGround(column, row)) continue;
        if (!IsGround(column, row - 1)) Leaving(column, row) |= 1;
        if (!IsGround(column + 1, row)) Leaving(column + 1, row) |= 2;
        if (!IsGround(column, row + 1)) Leaving(column + 1, row + 1) |= 4;
        if (!IsGround(column - 1, row)) Leaving(column, row + 1) |= 8;
      }
    }
    Rings rings;
    for (int row = 0; row <= raster_.rows; ++row)
      for (int column = 0; column <= raster_.columns; ++column)
        while (Leaving(column, row) != 0) rings.push_back(Follow(column, row));
    return rings;
  }

 private:
  bool IsGround(int column, int row) const {
    if (column < 0 || row < 0 || column >= raster_.columns || row >= raster_.rows) return false;
    return raster_.kind[RowMajor(row, raster_.columns, column)] != 0;
  }
  uint8_t& Leaving(int column, int row) {
    return leaving_[static_cast<size_t>(row) * stride_ + static_cast<size_t>(column)];
  }

  // Turns left where two ways lead on, so that cells which touch at a corner stay apart.
  Ring Follow(int column, int row) {
    Ring ring;
    int direction = -1;
    while (Leaving(column, row) != 0) {
      uint8_t& out = Leaving(column, row);
      int next = -1;
      for (const int turn : {1, 0, 3})
        if (next < 0 && direction >= 0 && (out & (1 << ((direction + turn) % 4)))) next = (direction + turn) % 4;
      for (int d = 0; d < 4 && next < 0; ++d)
        if (out & (1 << d)) next = d;
      out = static_cast<uint8_t>(out & ~(1 << next));
      if (next != direction)
        ring.push_back({raster_.min_m.x + column * static_cast<double>(raster_.cell_m),
                        raster_.min_m.y + row * static_cast<double>(raster_.cell_m)});
      direction = next;
      static constexpr std::array<std::array<int, 2>, 4> kSteps{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
      column += At(kSteps, next)[0];
      row += At(kSteps, next)[1];
    }
    return ring;
  }

  const GroundRaster& raster_;
  size_t stride_;
  std::vector<uint8_t> leaving_;
};

}  // namespace

Rings OutlineOf(const GroundRaster& raster) {
  Rings rings = Tracer(raster).Trace();
  std::erase_if(rings,
                [](const Ring& ring) { return ring.size() < 3 || std::abs(SignedArea(ring)) < kMinGroundHole_m2; });
  return UnionOfAreas(Simplify(rings, 0.9 * raster.cell_m));
}

}  // namespace flaneur
