// Whether the tour's stops and places are where somebody can be, as the player finds it when it starts, and whether
// anybody is met there.
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/footprint.h"
#include "runtime/tour_data/tour_data.h"

namespace flaneur {

// A line for each stop and place in an obstacle, off the ground or out of reach for somebody of person_radius_m, with
// what the player makes of it. All in the town's coordinates.
std::vector<std::string> PlacesNobodyReaches(const Footprints& footprints, const GroundRaster& ground,
                                             const std::vector<TourStop>& stops, const std::vector<Place>& places,
                                             float person_radius_m);

// A line where a crowd that goes anywhere, since no places tell where, is so thin over the walkable ground that one
// hardly meets anybody; else empty. A crowd of fewer than ten is taken to be meant so.
std::string DoubtOfThinCrowd(const Footprints& footprints, const GroundRaster& ground, const std::vector<Place>& places,
                             int people, float person_radius_m);

}  // namespace flaneur
