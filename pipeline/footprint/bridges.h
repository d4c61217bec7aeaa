// What of a bridge keeps a person from walking over or under it. Internal to the extraction.
#pragma once
#include "pipeline/footprint/shape.h"
#include "pipeline/footprint/stand.h"

namespace flaneur {

// Its pylons, whether they stand under the deck or on it, and what rises from the deck. The deck itself, and wider
// parts that carry it, are walked over: where the town has terrain their sides are walls, but not where the deck leads
// on to the ground.
Shape BridgeShape(const Site& site, const TownObject& bridge);

}  // namespace flaneur
