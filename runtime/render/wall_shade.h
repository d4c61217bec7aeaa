// The faint shade at the foot of walls and trunks, where everything near keeps the sky from the ground: a strip on the
// ground about each obstacle. For towns whose ground brings no shade of its own. Internal to runtime/render; no OpenGL.
#pragma once
#include <cstdint>
#include <vector>

#include "runtime/pack/tour_pack.h"
#include "runtime/render/projection.h"

namespace flaneur {

struct WallShadeVertex {
  Vec3 position;  // glTF axes, on the ground
  float out = 0;  // 0 at the wall, 1 where the shade ends
};

struct WallShadeBlock {  // neighbours
  Box box;
  uint32_t first = 0, count = 0;  // of the corners
};

struct WallShade {
  std::vector<WallShadeVertex> corners;  // three a triangle
  std::vector<WallShadeBlock> blocks;
};

// Nothing where obstacles touch each other, nor where there is no ground.
WallShade BuildWallShade(const Obstacles& obstacles, const GroundRaster& ground);

// Whether some ground of the town has light in the colours of its vertices: they are lighter and darker within one
// surface that looks up.
bool GroundHasShade(const TourPack& pack);

}  // namespace flaneur
