// The town as one vertex and one index array, cut into square blocks that are drawn or left out as wholes.
// Internal to runtime/render; no OpenGL.
#pragma once
#include <cstdint>
#include <vector>

#include "runtime/pack/tour_pack.h"
#include "runtime/render/projection.h"

namespace flaneur {

struct TownVertex {         // as the vertex shader reads it
  Vec3 position;            // world, glTF axes
  std::array<int8_t, 4> normal;    // normalized; the fourth is padding
  Vec2 uv;
  std::array<uint8_t, 4> color;    // normalized; the material's base colour is in it
};

struct TownRange { int material = -1; uint32_t first = 0, count = 0; };  // of the indices

struct TownBlock {
  Box box;
  std::vector<TownRange> ranges;  // one a material, following each other in the index array
  int64_t triangles = 0;
};

struct TownGeometry {
  std::vector<TownVertex> vertices;
  std::vector<uint32_t> indices;
  std::vector<TownBlock> blocks;
};

TownGeometry BuildTownGeometry(const TourPack& pack);

}  // namespace flaneur
