// Editable geometry, materials and images. All lengths in metres, glTF axes (Y up).
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/base/math.h"

namespace flaneur {

struct Image {
  std::string name;
  std::string mime_type;       // image/png or image/jpeg
  std::vector<uint8_t> bytes;  // encoded, as in the file
};

inline constexpr uint8_t kEveryTint = 0xFF;

struct Material {
  std::string name;
  Vec4 base_color{1, 1, 1, 1};  // linear
  int base_color_image = -1;    // sRGB; index into the owner's images, -1: none
  int normal_image = -1;
  float metallic = 0;
  float roughness = 1;
  bool double_sided = false;
  enum class Alpha { kOpaque, kMask, kBlend } alpha = Alpha::kOpaque;
  float alpha_cutoff = 0.5f;
  uint8_t tints = kEveryTint;  // bit t: the avatar's t-th tint may dye it
};

// One material's triangles. Every per-vertex array is either empty or as long as positions.
struct Mesh {
  std::string name;
  int material = -1;  // index into the owner's materials, -1: white
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;                    // unit
  std::vector<Vec2> uvs;                        // TEXCOORD_0, glTF's: (0, 0) is the upper left corner
  std::vector<Vec2> uvs1;                       // TEXCOORD_1
  std::vector<Vec4> colors;                     // COLOR_0, linear
  std::vector<std::array<uint16_t, 4>> joints;  // indices into Avatar::joints
  std::vector<std::array<float, 4>> weights;    // sum to 1
  std::vector<uint32_t> indices;                // triangles, anticlockwise seen from outside
};

inline int TriangleCount(const Mesh& mesh) { return static_cast<int>(mesh.indices.size() / 3); }
inline int TriangleCount(const std::vector<Mesh>& meshes) {
  int count = 0;
  for (const Mesh& mesh : meshes) count += TriangleCount(mesh);
  return count;
}

}  // namespace flaneur
