// The nodes that show a town. Internal to runtime/pack.
#pragma once
#include "runtime/pack/gltf_file.h"
#include "runtime/pack/mesh_table.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {

// Adds the town's instances and turning parts. Throws PackRefused.
void ReadTown(const GltfFile& file, MeshTable* meshes, TourPack* pack);

}  // namespace flaneur
