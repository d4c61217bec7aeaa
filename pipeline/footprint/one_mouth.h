// Rooms that a building's walls enclose but for one gap: a wall's piece or a door leaf that the model lacks.
#pragma once
#include <functional>

#include "pipeline/footprint/polygon_sets.h"

namespace flaneur {

// The regions that `walls` (lines) and `solid` (areas) enclose once the one gap between two loose ends is drawn
// straight, and that `is_solid` takes. Each is clearly wider than its gap, so that neither passages that end somewhere
// nor carports count, and the gap is a small share of its outline. Walls that miss each other by up to reach_m meet.
Rings RoomsWithOneMouth(const std::vector<Segment>& walls, const Rings& solid, double reach_m,
                        const std::function<bool(const Rings&)>& is_solid);

}  // namespace flaneur
