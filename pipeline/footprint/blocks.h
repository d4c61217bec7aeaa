// Houses that stand wall to wall. Internal to the extraction.
#pragma once
#include <vector>

#include "pipeline/footprint/shape.h"
#include "pipeline/footprint/stand.h"

namespace flaneur {

using Block = std::vector<size_t>;  // of objects, rising

// Groups of buildings and walls whose boxes lie within reach of each other; all other objects alone.
std::vector<Block> BlocksOf(const std::vector<TownObject>& objects);

// Houses that lean on each other often lack the wall between them: what only the block as a whole encloses goes to the
// house that stands over it.
void ShareBlock(const Site& site, const std::vector<TownObject>& objects, const Block& whole_block,
                std::vector<Shape>* shapes);

// Gives all of a block to its first object, whose shell is open where any of theirs is.
void MergeBlock(const Block& block, std::vector<Shape>* shapes);

}  // namespace flaneur
