// One triangle mesh to and from Draco's bytes, as KHR_draco_mesh_compression uses them.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/core/mesh.h"
#include "pipeline/io/gltf_builder.h"
#include "runtime/base/error.h"

namespace flaneur {

// One attribute to decode: Draco's own id, and floats out. Integers come as they are, unless the
// Draco attribute itself is marked as normalised.
struct DracoAttribute {
  int id = 0;
  int components = 0;         // out
  bool normalized = false;    // out: already scaled to 0..1 or -1..1
  std::vector<float> values;  // out, `components` a vertex
};

Error DecodeDraco(std::span<const uint8_t> bytes, std::span<DracoAttribute> attributes, std::vector<uint32_t>* indices);

// The cube that positions are rounded in; meshes with the same grid stay joined where they touch.
struct PositionGrid {
  Vec3 min;
  float size_m = 1;
};

struct DracoMesh {
  std::vector<uint8_t> bytes;
  // Draco's ids; -1: the mesh has none.
  int position = -1, normal = -1, uv = -1, uv1 = -1, color = -1, joints = -1, weights = -1;
  int vertices = 0, triangles = 0;  // after decoding
  Vec3 min, max;                    // of the decoded positions
};

// Weights as bytes that sum to 255, joints as bytes where `byte_joints`, else 16-bit.
Error EncodeDraco(const Mesh& mesh, const DracoOptions& options, const PositionGrid& grid, bool byte_joints,
                  DracoMesh* out);

// Weights that sum to 1 as bytes that sum to 255, by largest remainder.
std::array<uint8_t, 4> WeightBytes(const std::array<float, 4>& weights);

}  // namespace flaneur
