// The ground under an object of a town that has no terrain, told by the object's own geometry.
#pragma once
#include <vector>

#include "pipeline/footprint/rasterize_ground.h"
#include "pipeline/footprint/town_objects.h"

namespace flaneur {

// Objects beside an object, which tell of its ground too.
using Neighbours = std::vector<const TownObject*>;

// For each object those that adjoin it, by their numbers.
std::vector<Neighbours> NeighboursOf(const std::vector<TownObject>& objects,
                                     const std::vector<std::vector<size_t>>& adjoining);

// Those of them that tell something of the ground under an object of a town without terrain: none where the object
// knows that itself.
std::vector<Neighbours> TellingOfGround(const std::vector<TownObject>& objects,
                                        const std::vector<std::vector<size_t>>& adjoining);

// Where the object's foundation lies, else its floor, else the feet of its walls; cells of which nothing is known have
// no kind. Walls that stand on roofs or hang from ceilings, the object's own or its neighbours', and parts that hang
// over lower ones and are narrower than 6 m (arcades, passages, jetties) do not count as feet.
GroundRaster BaseOf(const TownObject& object, const Neighbours& neighbours = {});

// One ground, or two where the object stands on terraces: at a step, walls of the upper and of the lower terrace are in
// the way, each above its own ground.
std::vector<LocalGround> GroundsUnder(const TownObject& object, const Neighbours& neighbours = {});

}  // namespace flaneur
