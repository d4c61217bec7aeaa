// Obstacles that touch without overlapping.
#pragma once
#include <vector>

#include "pipeline/footprint/shape.h"
#include "pipeline/footprint/town_objects.h"

namespace flaneur {

// `enlarged`: each object's outline with its clearance, in and out. Neighbours overlap by twice the clearance: each
// keeps clear of the others' walls, and of what the earlier ones have taken; only where two houses stand in each other
// by more than 1.5 m both keep what is theirs. Parts thinner than width_m go to a neighbour or vanish. The same for any
// number of threads.
void SeparateObstacles(const std::vector<TownObject>& objects, const std::vector<Shape>& shapes, double width_m,
                       int threads, std::vector<Rings>* enlarged);

}  // namespace flaneur
