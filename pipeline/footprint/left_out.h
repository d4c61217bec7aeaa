// Says what of a town leaves no obstacle. Internal to the extraction.
#pragma once
#include <string>
#include <vector>

#include "pipeline/footprint/shape.h"
#include "pipeline/footprint/stand.h"

namespace flaneur {

// One line for each object that has no obstacle or only a part of one, with the reason; flat things in one line.
void WarnOfLeftOut(const Site& site, const TownObjects& town, const std::vector<Shape>& shapes,
                   const std::vector<Rings>& outlines, const std::vector<bool>& has_obstacle,
                   std::vector<std::string>* warnings);

}  // namespace flaneur
