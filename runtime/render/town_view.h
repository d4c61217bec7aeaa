// Draws the town. Internal to runtime/render.
#pragma once
#include <vector>

#include "runtime/base/error.h"
#include "runtime/render/gl_objects.h"
#include "runtime/render/textures.h"
#include "runtime/render/town_geometry.h"

namespace flaneur {

struct SurfacePrograms { GLuint plain = 0, masked = 0; };  // masked: cut out by the surface's alpha

struct TownView {
  SurfacePrograms lit, shadow;
  GLuint vertex_array = 0;
  std::vector<TownBlock> blocks;
  std::vector<Surface> surfaces;                       // by material; the last one of none
  std::vector<std::pair<float, const TownBlock*>> order;  // scratch: distance and block
};

// `defines`: of the lit programs.
Error CreateTownView(const TourPack& pack, const std::string& defines, const std::vector<Surface>& surfaces, TownView* town);

// Near blocks first, so that hidden pixels cost little. Returns the triangles drawn. The frame block must be bound.
int64_t DrawTown(const Mat4& view_projection, Vec3 eye, bool cull, TownView* town);

// Depth only: the blocks of index first, first + step, ... that the light's view touches.
void DrawTownShadow(const Mat4& light_projection, size_t first, size_t step, const TownView& town);

// Binds the surface's program, texture and culling.
void BindSurface(const SurfacePrograms& programs, const Surface& surface);
const Surface& SurfaceOf(int material, const std::vector<Surface>& surfaces);

}  // namespace flaneur
