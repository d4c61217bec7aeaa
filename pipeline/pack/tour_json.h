// The root extension FLANEUR_tour as JSON. Internal to pipeline/pack.
#pragma once
#include <string>

#include "pipeline/pack/write_tour_pack.h"

namespace flaneur {

std::string TourJson(const TourParts& parts, const TourIndices& indices);

}  // namespace flaneur
