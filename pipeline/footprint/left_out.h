// Says what of a town leaves no obstacle. Internal to the extraction.
#pragma once
#include <string>
#include <vector>

#include "pipeline/footprint/shape.h"
#include "pipeline/footprint/stand.h"

namespace flaneur {

// Names each object that has no obstacle or only a part of one, one line a reason; flat things in one line too.
void WarnOfLeftOut(const Site& site, const TownObjects& town, const std::vector<Shape>& shapes,
                   const std::vector<Rings>& outlines, const std::vector<bool>& has_obstacle,
                   std::vector<std::string>* warnings);

}  // namespace flaneur
