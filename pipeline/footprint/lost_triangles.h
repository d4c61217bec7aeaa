// What is done about triangles that a town has lost. Internal to the extraction.
#pragma once
#include <vector>

#include "pipeline/footprint/blocks.h"
#include "pipeline/footprint/shape.h"
#include "pipeline/footprint/stand.h"

namespace flaneur {

// A floor for each building that has none; which of them have one now. Not vector<bool>: threads write beside each
// other.
std::vector<char> FindFloors(const FootprintOptions& options, double least_share, std::vector<TownObject>* objects);

// Whether triangles were lost all over the town, as in a spoilt file: then some walls are missing whole. If so, those
// that are missing from what houses have together are put back, what is left of a floor is one, and the shapes of
// houses that this changes are made anew.
bool PutBackLost(const Site& site, const std::vector<Block>& blocks, const std::vector<Neighbours>& neighbours,
                 std::vector<TownObject>* objects, std::vector<Shape>* shapes);

}  // namespace flaneur
