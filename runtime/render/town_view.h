// Draws the town. Internal to runtime/render.
#pragma once
#include <memory>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/render/gl_objects.h"
#include "runtime/render/occlusion.h"
#include "runtime/render/town_geometry.h"

namespace flaneur {

// Of a town that comes.
struct TownUpload {
  GLuint vertices = 0, indices = 0;  // buffers
  size_t done_bytes = 0;
};

struct TownView {
  Program lit[2], shadow[2];  // [masked]
  GLuint vertex_array = 0, shadow_array = 0, visible_indices = 0;
  GLuint vertices = 0, shadow_indices = 0;
  TownGeometry geometry;  // without its vertices
  std::vector<SurfaceGroup> groups;
  std::vector<int> masked_groups;  // that the town has, in the order in which they stand in the index array
  std::vector<GLuint> arrays;
  Box box;  // of all blocks
  bool triangle_by_triangle =
      false;  // software, where a triangle costs more than a look at it, and pictures have one sample a pixel
  // Of the last picture.
  OcclusionMap walls;
  std::vector<std::pair<float, uint32_t>> order;  // scratch: distance and block
  std::vector<uint32_t> visible;                  // blocks, nearest first
  std::unique_ptr<uint32_t[]>
      indices;  // of them, group by group; room for all, of which no more is touched than pictures need
  std::vector<uint32_t> counts;  // of indices, by group
  // Parts that turn: where they have turned to stands behind the `still` vertices.
  uint32_t still = 0;
  std::vector<TownVertex> turned;                // scratch
  std::vector<std::vector<uint32_t>> turned_of;  // of the last picture, by group
  TownUpload upload;
};

Error CreateTownView(ShaderMode mode, const SurfacePlan& plan, const std::vector<GLuint>& arrays, TownView* town);
// About so many bytes more of what AddTown takes then; true: that was all. Meanwhile the one before is drawn.
bool UploadTown(size_t most_bytes, const TownGeometry& geometry, TownView* town);
// Of what was uploaded, instead of the one that was added before.
void AddTown(TownGeometry geometry, TownView* town);

// Fills visible and walls: blocks within the view that no nearer walls hide. Without `cull` all blocks and no walls.
void FindVisibleBlocks(const Mat4& view_projection, Vec3 eye, bool cull, TownView* town);

// Near blocks first, so that hidden pixels cost little, without what turns its back to the eye: software would shade
// its corners. Without `cull` all of the blocks. width_px, height_px: of what is drawn. The frame block must be bound.
DrawCost DrawTown(Vec3 eye, int width_px, int height_px, bool cull, TownView* town);

// Parts that turn are drawn with the town, where they have turned to: FrameInput::turns_rad. After FindVisibleBlocks,
// for what walls hide is left out.
void PlaceTurningParts(const Mat4& view_projection, const std::vector<float>& turns_rad, bool cull, TownView* town);

// Depth only, step by step: all blocks' opaque triangles, then of each group that is cut out all blocks' again. From
// *next_step on what the light's view touches, until `triangles` are drawn. *next_step: where to go on.
size_t ShadowSteps(const TownView& town);
DrawCost DrawTownShadow(const Mat4& light_projection, int64_t triangles, const TownView& town, size_t* next_step);

}  // namespace flaneur
