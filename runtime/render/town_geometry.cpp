#include "runtime/render/town_geometry.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace flaneur {
namespace {

constexpr float kBlock_m = 12;   // about a house: the two sides of a street and the yards behind part into different blocks

using Cell = std::pair<int, int>;

int8_t SignedByte(float v) { return static_cast<int8_t>(std::lround(std::clamp(v, -1.0f, 1.0f) * 127)); }
uint8_t Byte(float v) { return static_cast<uint8_t>(std::clamp(v, 0.0f, 1.0f) * 255 + 0.5f); }

bool Mirrors(const Mat4& m) {
  const auto column = [&](size_t c) { return Vec3{m.m[c][0], m.m[c][1], m.m[c][2]}; };
  return Dot(Cross(column(0), column(1)), column(2)) < 0;
}

// Normals turn with the inverse transpose.
Vec3 TurnNormal(const Mat4& inverse, Vec3 n) {
  return Normalized(Vec3{inverse.m[0][0] * n.x + inverse.m[0][1] * n.y + inverse.m[0][2] * n.z,
                         inverse.m[1][0] * n.x + inverse.m[1][1] * n.y + inverse.m[1][2] * n.z,
                         inverse.m[2][0] * n.x + inverse.m[2][1] * n.y + inverse.m[2][2] * n.z});
}

struct Triangle { int material; std::array<uint32_t, 3> corners; };

void AppendVertices(const PackPrimitive& p, const Mat4& world, const Vec4& base, TownGeometry* town) {
  const Mat4 inverse = Inverse(world);
  for (size_t i = 0; i < p.positions.size(); ++i) {
    const Vec3 n = TurnNormal(inverse, p.normals[i]);
    const Vec4 c = p.colors.empty() ? Vec4{1, 1, 1, 1} : p.colors[i];
    town->vertices.push_back({TransformPoint(world, p.positions[i]),
                              {SignedByte(n.x), SignedByte(n.y), SignedByte(n.z), 0},
                              p.uvs.empty() ? Vec2{} : p.uvs[i],
                              {Byte(c.x * base.x), Byte(c.y * base.y), Byte(c.z * base.z), Byte(c.w * base.w)}});
  }
}

Cell CellOf(const std::array<uint32_t, 3>& corners, const TownGeometry& town) {
  Vec3 sum;
  for (uint32_t c : corners) sum = sum + town.vertices[c].position;
  return {static_cast<int>(std::floor(sum.x / 3 / kBlock_m)), static_cast<int>(std::floor(sum.z / 3 / kBlock_m))};
}

// The index array in order of block and material; vertices in order of their first use, so that a block's lie together.
void PackBlocks(std::map<Cell, std::vector<Triangle>>* cells, TownGeometry* town) {
  const std::vector<TownVertex> all = std::move(town->vertices);
  std::vector<uint32_t> place(all.size(), UINT32_MAX);
  town->vertices.clear();
  town->vertices.reserve(all.size());
  for (auto& [cell, triangles] : *cells) {
    std::stable_sort(triangles.begin(), triangles.end(), [](const Triangle& a, const Triangle& b) { return a.material < b.material; });
    TownBlock block;
    block.triangles = static_cast<int64_t>(triangles.size());
    for (const Triangle& t : triangles) {
      if (block.ranges.empty() || block.ranges.back().material != t.material) {
        block.ranges.push_back({t.material, static_cast<uint32_t>(town->indices.size()), 0});
      }
      for (uint32_t corner : t.corners) {
        if (place[corner] == UINT32_MAX) {
          place[corner] = static_cast<uint32_t>(town->vertices.size());
          town->vertices.push_back(all[corner]);
        }
        town->indices.push_back(place[corner]);
        Include(all[corner].position, &block.box);
      }
      block.ranges.back().count += 3;
    }
    town->blocks.push_back(std::move(block));
  }
}

}  // namespace

TownGeometry BuildTownGeometry(const TourPack& pack) {
  TownGeometry town;
  std::map<Cell, std::vector<Triangle>> cells;
  for (const TownInstance& instance : pack.town) {
    const bool mirrored = Mirrors(instance.world);
    for (const PackPrimitive& p : pack.meshes[static_cast<size_t>(instance.mesh)].primitives) {
      const auto base = static_cast<uint32_t>(town.vertices.size());
      const Vec4 color = p.material >= 0 ? pack.materials[static_cast<size_t>(p.material)].base_color : Vec4{1, 1, 1, 1};
      AppendVertices(p, instance.world, color, &town);
      for (size_t i = 0; i + 2 < p.indices.size(); i += 3) {
        Triangle t{p.material, {base + p.indices[i], base + p.indices[i + 1], base + p.indices[i + 2]}};
        if (mirrored) std::swap(t.corners[1], t.corners[2]);
        cells[CellOf(t.corners, town)].push_back(t);
      }
    }
  }
  PackBlocks(&cells, &town);
  return town;
}

}  // namespace flaneur
