// What a pack says of a town's life besides its people. Internal to runtime/pack.
#pragma once
#include "runtime/pack/tour_object.h"
#include "runtime/tour_data/tour_data.h"

namespace flaneur {

// Throws PackRefused.
void ReadLife(const TourObject& tour, TourData* data);

}  // namespace flaneur
