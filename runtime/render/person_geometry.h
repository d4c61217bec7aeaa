// People's meshes as the vertex shader reads them, and a plain one for shadows. Internal to runtime/render; no OpenGL.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "runtime/pack/tour_pack.h"
#include "runtime/render/surface_plan.h"

namespace flaneur {

struct PersonVertex {
  Vec3 position;
  std::array<int8_t, 4> normal;  // normalized; the fourth is the layer of the picture
  Vec2 uv;
  std::array<uint8_t, 4> color;  // normalized; the material's base colour is in it
  std::array<uint16_t, 4> joints;
  std::array<uint8_t, 4> weights;  // normalized
  std::array<uint8_t, 4> dyed;     // normalized; by tint whether it may dye the material, the last unused
};

struct PersonRange {
  int group = 0;
  uint32_t first = 0, count = 0;
};  // of the indices

struct PersonGeometry {
  std::vector<PersonVertex> vertices;
  std::vector<uint32_t> indices;
  std::vector<PersonRange> ranges;  // one a group
};

PersonGeometry BuildPersonGeometry(const TourPack& pack, const PackMesh& mesh, const SurfacePlan& plan);

// The shape alone: of all vertices within a cell of `cell_m` the one farthest from the figure's middle, so that hats
// and hems keep their size, on the heaviest of its joints. Limbs much thinner than a cell, of which nothing would be
// left, are two strips that cross. Cells are larger where there were more than `most_triangles` else.
PersonGeometry ShadowGeometry(const PersonGeometry& of, float cell_m, size_t most_triangles);

using ShadowLevels = std::array<PersonGeometry, 2>;  // for shadows near the eye, and farther off

}  // namespace flaneur
