// A pack's materials and their pictures. Internal to runtime/pack.
#pragma once
#include <span>
#include <string>

#include "runtime/pack/gltf_file.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {

// By number and, where it has one, name: for messages.
std::string NameOf(const GltfFile& file, int image);

// The buffer view of an image, and what lies in it.
int ImageView(const GltfFile& file, int image);
std::span<const uint8_t> ImageBytes(const GltfFile& file, int image);

// All of these throw PackRefused. The size alone needs no more of the image than its beginning.
PackImage ReadImageSize(const GltfFile& file, int index);
PackImage ReadImage(const GltfFile& file, int index);
PackMaterial ReadMaterial(const GltfFile& file, const Json& json);

}  // namespace flaneur
