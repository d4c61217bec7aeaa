#include "runtime/render/person_geometry.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "runtime/render/projection.h"
#include "runtime/render/vertex_bytes.h"

namespace flaneur {
namespace {

constexpr float kLargerCells = 1.2f;

void AppendVertices(const PackPrimitive& p, const PackMaterial& material, int layer,
                    std::vector<PersonVertex>* vertices) {
  const Vec4 base = material.base_color;
  std::array<uint8_t, 4> dyed{};
  for (size_t t = 0; t < kMaxTints; ++t) dyed[t] = material.tints >> t & 1 ? 255 : 0;
  for (size_t i = 0; i < p.positions.size(); ++i) {
    const Vec4 c = p.colors.empty() ? Vec4{1, 1, 1, 1} : p.colors[i];
    const Vec3 n = p.normals[i];
    PersonVertex v{p.positions[i],
                   {SignedByte(n.x), SignedByte(n.y), SignedByte(n.z), static_cast<int8_t>(layer)},
                   p.uvs.empty() ? Vec2{} : p.uvs[i],
                   {SrgbByte(c.x * base.x), SrgbByte(c.y * base.y), SrgbByte(c.z * base.z), Byte(c.w * base.w)},
                   {},
                   {255, 0, 0, 0},
                   dyed};
    if (!p.joints.empty()) {
      v.joints = p.joints[i];
      v.weights = p.weights[i];
    }
    vertices->push_back(v);
  }
}

PersonVertex OnHeaviestJoint(PersonVertex v) {
  v.joints[0] = v.joints[static_cast<size_t>(std::max_element(v.weights.begin(), v.weights.end()) - v.weights.begin())];
  v.weights = {255, 0, 0, 0};
  return v;
}

PersonGeometry WithinCells(const PersonGeometry& of, float cell_m) {
  PersonGeometry out;
  std::map<std::array<int, 3>, uint32_t> cells;
  std::vector<uint32_t> place(of.vertices.size());
  Box box;
  for (const PersonVertex& v : of.vertices) Include(v.position, &box);
  const Vec3 middle = (box.low + box.high) * 0.5f;
  for (size_t i = 0; i < of.vertices.size(); ++i) {
    const Vec3 p = of.vertices[i].position;
    const auto cell = [cell_m](float v) { return static_cast<int>(std::floor(v / cell_m)); };
    const auto [found, fresh] =
        cells.try_emplace({cell(p.x), cell(p.y), cell(p.z)}, static_cast<uint32_t>(out.vertices.size()));
    place[i] = found->second;
    if (fresh) out.vertices.push_back(OnHeaviestJoint(of.vertices[i]));
    // The outermost stands for all in the cell, so that hats and hems keep their size.
    PersonVertex& kept = out.vertices[place[i]];
    if (Length(p - middle) > Length(kept.position - middle)) kept = OnHeaviestJoint(of.vertices[i]);
  }
  std::set<std::array<uint32_t, 3>> seen;  // layers of cloth fall together
  for (size_t i = 0; i + 2 < of.indices.size(); i += 3) {
    std::array<uint32_t, 3> t{place[of.indices[i]], place[of.indices[i + 1]], place[of.indices[i + 2]]};
    std::sort(t.begin(), t.end());  // a shadow has no front
    if (t[0] == t[1] || t[1] == t[2] || !seen.insert(t).second) continue;
    out.indices.insert(out.indices.end(), t.begin(), t.end());
  }
  out.ranges = {{0, 0, static_cast<uint32_t>(out.indices.size())}};
  return out;
}

}  // namespace

PersonGeometry BuildPersonGeometry(const TourPack& pack, const PackMesh& mesh, const SurfacePlan& plan) {
  PersonGeometry out;
  std::vector<const PackPrimitive*> primitives;
  for (const PackPrimitive& p : mesh.primitives) primitives.push_back(&p);
  std::stable_sort(primitives.begin(), primitives.end(), [&](const PackPrimitive* a, const PackPrimitive* b) {
    return SurfaceOf(a->material, plan).group < SurfaceOf(b->material, plan).group;
  });
  for (const PackPrimitive* p : primitives) {
    const Surface& surface = SurfaceOf(p->material, plan);
    if (out.ranges.empty() || out.ranges.back().group != surface.group) {
      out.ranges.push_back({surface.group, static_cast<uint32_t>(out.indices.size()), 0});
    }
    out.ranges.back().count += static_cast<uint32_t>(p->indices.size());
    const auto base = static_cast<uint32_t>(out.vertices.size());
    AppendVertices(*p, p->material >= 0 ? pack.materials[static_cast<size_t>(p->material)] : PackMaterial{},
                   surface.layer, &out.vertices);
    for (uint32_t i : p->indices) out.indices.push_back(base + i);
  }
  return out;
}

PersonGeometry ShadowGeometry(const PersonGeometry& of, float cell_m, size_t most_triangles) {
  PersonGeometry out = WithinCells(of, cell_m);
  while (out.indices.size() / 3 > most_triangles) out = WithinCells(of, cell_m *= kLargerCells);
  return out;
}

}  // namespace flaneur
