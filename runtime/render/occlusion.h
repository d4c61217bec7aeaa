// What stands behind walls: a small picture of depths, drawn on the CPU with the walls nearest to the eye. Internal to
// runtime/render; no OpenGL.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/render/projection.h"

namespace flaneur {

// Depths are kept as 1 / w: largest nearest, 0 where there is no wall.
struct OcclusionMap {
  Mat4 view_projection;
  std::vector<float> nearness;  // kOcclusionWidth x kOcclusionHeight, row 0 at the bottom
  std::vector<float> farthest;  // of each tile of kTile x kTile: the least nearness in it
};

inline constexpr int kOcclusionWidth = 256, kOcclusionHeight = 144, kTile = 8;

void ClearOcclusion(const Mat4& view_projection, OcclusionMap* map);

// Three corners a triangle, as indices of positions, seen from the side from which they go round anticlockwise.
void AddWalls(std::span<const Vec3> positions, std::span<const uint32_t> corners, OcclusionMap* map);

// After all walls.
void FinishOcclusion(OcclusionMap* map);

// False only where walls hide the whole box, judged by the centres of the map's pixels with one more all around. Before
// FinishOcclusion slower.
bool MayBeSeen(const OcclusionMap& map, const Box& box, bool finished);

}  // namespace flaneur
