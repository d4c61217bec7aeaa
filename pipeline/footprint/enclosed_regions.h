// The regions that line segments enclose, found with exact arithmetic.
#pragma once
#include <functional>
#include <vector>

#include "pipeline/footprint/polygon_sets.h"

namespace flaneur {

struct EnclosedRegions {
  Rings solid;                 // the regions that `is_solid` took; slivers thinner than 0.1 mm vanish
  std::vector<Segment> loose;  // pieces of segments with nothing solid beside them
};

// A region is enclosed where no way leads to it from outside without crossing a segment. is_solid is asked once for
// each, with its area and points inside it, each with the area it stands for. Segments may cross, overlap and repeat,
// but that takes much longer than where they meet at their ends only (see CutWhereTheyMeet). Deterministic for the same
// segments in the same order.
using RegionSample = std::pair<Point2, double>;
using RegionTest = std::function<bool(double area_m2, const std::vector<RegionSample>& samples)>;
EnclosedRegions EncloseRegions(const std::vector<Segment>& segments, const RegionTest& is_solid);

}  // namespace flaneur
