// One of a pack's avatars. Internal to runtime/pack.
#pragma once
#include <vector>

#include "runtime/pack/gltf_file.h"
#include "runtime/pack/mesh_table.h"
#include "runtime/pack/tour_object.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {

// All of these throw PackRefused. The impostor comes without its pictures.
PackAvatar ReadAvatar(const GltfFile& file, const TourObject& json, MeshTable* meshes);
void CheckJoints(const PackPrimitive& primitive, int joints);

// Notes in the materials of an avatar's levels which tints may dye them.
void BindTints(const PackAvatar& avatar, const std::vector<PackMesh>& meshes, Allowance* allowance,
               std::vector<PackMaterial>* materials);

}  // namespace flaneur
