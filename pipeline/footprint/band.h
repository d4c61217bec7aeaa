// What of an object stands in the way of a person: its part in the height band over the local ground, in plan.
#pragma once
#include <array>
#include <vector>

#include "pipeline/footprint/polygon_sets.h"
#include "pipeline/footprint/rasterize_ground.h"
#include "pipeline/footprint/town_objects.h"

namespace flaneur {

struct BandParts {
  std::vector<Segment> walls;  // upright faces on a grid of 1 mm, sorted, each once
  Rings areas;                 // parts that cover ground: sloping and level faces, united
};

// The walls outside the areas, and the areas' outlines.
std::vector<Segment> Lines(const BandParts& parts);

// Triangles are split along edges where the ground bends under them, cut to the band and projected. The result does not
// depend on the order or orientation of the triangles.
BandParts CutToBand(const std::vector<Triangle3>& triangles, const LocalGround& ground,
                    const std::array<double, 2>& band_m);

// Whether that gives anything.
bool AnyInBand(const std::vector<Triangle3>& triangles, const LocalGround& ground, const std::array<double, 2>& band_m);

}  // namespace flaneur
