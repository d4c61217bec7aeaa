#include "runtime/render/town_view.h"

#include <algorithm>
#include <cstddef>

#include "runtime/render/shaders.h"

namespace flaneur {
namespace {

void UploadGeometry(const TownGeometry& geometry, TownView* town) {
  glGenVertexArrays(1, &town->vertex_array);
  glBindVertexArray(town->vertex_array);
  CreateBuffer(GL_ARRAY_BUFFER, geometry.vertices.data(), geometry.vertices.size() * sizeof(TownVertex));
  CreateBuffer(GL_ELEMENT_ARRAY_BUFFER, geometry.indices.data(), geometry.indices.size() * sizeof(uint32_t));
  constexpr size_t stride = sizeof(TownVertex);
  EnableAttribute(0, 3, GL_FLOAT, false, stride, offsetof(TownVertex, position), 0);
  EnableAttribute(1, 4, GL_BYTE, true, stride, offsetof(TownVertex, normal), 0);
  EnableAttribute(2, 2, GL_FLOAT, false, stride, offsetof(TownVertex, uv), 0);
  EnableAttribute(3, 4, GL_UNSIGNED_BYTE, true, stride, offsetof(TownVertex, color), 0);
}

void DrawBlock(const TownBlock& block, const SurfacePrograms& programs, const TownView& town) {
  for (const TownRange& range : block.ranges) {
    BindSurface(programs, SurfaceOf(range.material, town.surfaces));
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(range.count), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(size_t{range.first} * sizeof(uint32_t)));
  }
}

}  // namespace

const Surface& SurfaceOf(int material, const std::vector<Surface>& surfaces) {
  return material >= 0 ? surfaces[static_cast<size_t>(material)] : surfaces.back();
}

void BindSurface(const SurfacePrograms& programs, const Surface& surface) {
  const GLuint program = surface.masked ? programs.masked : programs.plain;
  glUseProgram(program);
  if (surface.masked) SetUniform(program, "u_alpha_cutoff", surface.alpha_cutoff);
  BindTexture(kColorUnit, surface.texture);
  CullBackFaces(!surface.double_sided);
}

Error CreateTownView(const TourPack& pack, const std::string& defines, const std::vector<Surface>& surfaces, TownView* town) {
  const std::string vertex = std::string(kFrame) + kTownVertex, masked = "#define MASKED\n";
  const std::string lit = defines + kFrame + kLight + kSurfaceFragment;
  if (Error e = BuildProgram(vertex, lit, &town->lit.plain)) return e;
  if (Error e = BuildProgram(vertex, masked + lit, &town->lit.masked)) return e;
  if (Error e = BuildProgram(vertex, kShadowFragment, &town->shadow.plain)) return e;
  if (Error e = BuildProgram(vertex, masked + kShadowFragment, &town->shadow.masked)) return e;
  TownGeometry geometry = BuildTownGeometry(pack);
  UploadGeometry(geometry, town);
  town->blocks = std::move(geometry.blocks);
  town->surfaces = surfaces;
  return Ok();
}

int64_t DrawTown(const Mat4& view_projection, Vec3 eye, bool cull, TownView* town) {
  const Frustum frustum = FrustumOf(view_projection);
  town->order.clear();
  for (const TownBlock& block : town->blocks) {
    if (!cull || MayTouch(frustum, block.box)) town->order.push_back({Distance(block.box, eye), &block});
  }
  std::stable_sort(town->order.begin(), town->order.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  glBindVertexArray(town->vertex_array);
  int64_t triangles = 0;
  for (const auto& [distance_m, block] : town->order) {
    DrawBlock(*block, town->lit, *town);
    triangles += block->triangles;
  }
  return triangles;
}

void DrawTownShadow(const Mat4& light_projection, size_t first, size_t step, const TownView& town) {
  const Frustum frustum = FrustumOf(light_projection);
  glBindVertexArray(town.vertex_array);
  for (size_t i = first; i < town.blocks.size(); i += step) {
    if (MayTouch(frustum, town.blocks[i].box)) DrawBlock(town.blocks[i], town.shadow, town);
  }
}

}  // namespace flaneur
