// The pictures that stand for a far avatar. Internal to runtime/pack.
#pragma once
#include "runtime/pack/gltf_file.h"
#include "runtime/pack/tour_object.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {

// halved: how often the picture's sides are half the atlas's.
struct AtlasView {
  const char* name;
  int halved;
};
inline constexpr AtlasView kAtlasViews[] = {
    {"albedo_view", 0}, {"normal_view", 0}, {"depth_view", 0}, {"motion_view", 1}, {"tints_view", 1}};

// Without the pictures. Throws PackRefused, as ReadAtlas does.
PackImpostor ReadImpostor(const GltfFile& file, const TourObject& json);
void ReadAtlas(const GltfFile& file, const TourObject& json, PackImpostor* impostor);

}  // namespace flaneur
