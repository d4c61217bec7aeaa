// Where houses without floors stand, where that is plain from their shells. Internal to the extraction.
#pragma once
#include <vector>

#include "pipeline/footprint/blocks.h"

namespace flaneur {

// Houses that have corners in common are looked at together. Where some have nothing but walls below: finds the height
// at which the shell that they have together is open, if it lies lowest and is so everywhere: what is open elsewhere
// must lie over what is enclosed there. None where they stand on several heights, or on others' roofs. Such houses have
// no floor; a low flat roof might else be taken for one.
void FindLevelFeet(const std::vector<Block>& blocks, int threads, std::vector<TownObject>* objects);

}  // namespace flaneur
