// Houses that stand wall to wall. Internal to the extraction.
#pragma once
#include <vector>

#include "pipeline/footprint/shape.h"
#include "pipeline/footprint/stand.h"

namespace flaneur {

using Block = std::vector<size_t>;  // of objects, rising

// For each object the buildings and walls that adjoin it, rising; none for other kinds.
std::vector<std::vector<size_t>> Adjoining(const std::vector<TownObject>& objects);

// Groups of those that adjoin each other; all other objects alone.
std::vector<Block> BlocksOf(const std::vector<std::vector<size_t>>& adjoining);

// Whether the boxes of two objects lie within reach of each other.
bool Adjoin(const TownObject& a, const TownObject& b);

// What the objects enclose under their roofs together, and none of them by itself.
Rings EnclosedTogether(const Site& site, const std::vector<TownObject>& objects, const Block& block,
                       const std::vector<Shape>& shapes);

// Houses that lean on each other often lack the wall between them, and one may own the walls of all: what the block as
// a whole encloses goes to the houses whose ground surfaces, floors or roofs lie there, and what is left over to those
// that it lies against. A house that has a ground surface and a roof but no walls at all stands on its ground surface.
void ShareBlock(const Site& site, const std::vector<TownObject>& objects, const Block& whole_block,
                std::vector<Shape>* shapes);

// Gives all of a block to its first object, whose shell is open where any of theirs is.
void MergeBlock(const Block& block, std::vector<Shape>* shapes);

}  // namespace flaneur
