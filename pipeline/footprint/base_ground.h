// The ground under an object of a town that has no terrain, told by the object's own geometry.
#pragma once
#include <vector>

#include "pipeline/footprint/rasterize_ground.h"
#include "pipeline/footprint/town_objects.h"

namespace flaneur {

// Where the object's foundation lies, else the feet of its walls; cells of which nothing is known have no kind. Parts
// that hang over lower ones and are narrower than 6 m (arcades, passages, jetties) do not count as feet.
GroundRaster BaseOf(const TownObject& object);

// One ground, or two where the object stands on terraces: at a step, walls of the upper and of the lower terrace are in
// the way, each above its own ground.
std::vector<LocalGround> GroundsUnder(const TownObject& object);

}  // namespace flaneur
