// What the checks of ways share; see check_parts.h.
#pragma once
#include <string>
#include <vector>

#include "pipeline/footprint/check_parts.h"
#include "pipeline/footprint/way_network.h"

namespace flaneur {

// Its name; empty where there are no obstacles.
std::string NearestObstacle(const CheckState& state, Point2 p);

// 502, 503 on ground without the obstacles.
void CheckNetwork(const Rings& ground, const OpenTest& is_open, const std::vector<Gate>& gates, CheckState* state);

}  // namespace flaneur
