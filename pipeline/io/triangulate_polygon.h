// Triangles of a polygon in space.
#pragma once
#include <array>
#include <vector>

#include "pipeline/core/footprint.h"

namespace flaneur {

// Corners as indices into all rings' points, one ring after the other; turned as the first ring is. The polygon need
// not be quite plane. The inside is that of the even-odd rule; where rings cross, it is covered as well as their own
// points allow. Nothing where all points lie on a line, or where rings cross far more often than they have points.
std::vector<std::array<uint32_t, 3>> TriangulatePolygon(const std::vector<std::vector<Point3>>& rings);

}  // namespace flaneur
