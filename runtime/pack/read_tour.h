// What a pack says of its tour: obstacles, ground, places, stops, settings. Internal to runtime/pack.
#pragma once
#include "runtime/pack/gltf_file.h"
#include "runtime/pack/tour_object.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {

// All of these throw PackRefused.
void ReadTour(const GltfFile& file, const TourObject& tour, TourPack* pack);
GroundRaster ReadGround(const GltfFile& file, const TourObject& json);

}  // namespace flaneur
