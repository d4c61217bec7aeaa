// People where the tour's picture has them. Internal to runtime/town.
#pragma once
#include "runtime/town/town.h"

namespace flaneur {

// The cells that are painted in this layer of the simulation's painting, in random order, the stronger painted ones
// rather early: the first few follow the painting's density. `cells` in random order where nothing of it is painted.
std::vector<int> PaintedOrder(const std::vector<uint8_t>& layer, std::vector<int> cells, Town* town);

// Adds goals where people are painted, and loiter places where they are painted to stand about; those replace the
// town's own. Warns where a layer has paint, but none where people can be.
void AddPaintedPlaces(Town* town);

}  // namespace flaneur
