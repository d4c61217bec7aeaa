// A glTF mesh as runtime primitives. Internal to runtime/pack.
#pragma once
#include "runtime/pack/gltf_file.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {

// Plain or Draco-compressed. Every index is below the vertex count, every array as long as the positions, every
// position finite, weights sum to 255. Throws PackRefused naming the mesh.
PackMesh ReadMesh(const GltfFile& file, int mesh);
PackPrimitive ReadPrimitive(const GltfFile& file, int mesh, size_t primitive);
// What it says to hold; ReadMesh refuses one that holds more. Throws PackRefused.
struct MeshSize {
  uint64_t primitives = 0, vertices = 0, indices = 0;
};
MeshSize SizeOfMesh(const GltfFile& file, int mesh);

// The buffer views that it takes. Throws PackRefused.
std::vector<int> ViewsOfMesh(const GltfFile& file, int mesh);

}  // namespace flaneur
