// The floor of a building whose model does not say which of its faces that is.
#pragma once
#include <vector>

#include "pipeline/footprint/town_objects.h"

namespace flaneur {

// The nearly level faces that lie lowest and on which the walls round them stand. What hangs over lower parts of the
// same building (the ceiling of a passage, a balcony, a roof without a floor below) is none. Empty where the faces
// found would bear less than this share of the building, 0 to 1.
std::vector<Triangle3> FloorOf(const std::vector<Triangle3>& triangles, double least_share);

}  // namespace flaneur
