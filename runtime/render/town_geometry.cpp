#include "runtime/render/town_geometry.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "runtime/base/array.h"
#include "runtime/render/vertex_bytes.h"

namespace flaneur {
namespace {

constexpr float kBlock_m = 4;  // small enough that walls hide most of what they hide; smaller ones take the CPU longer
constexpr float kMinOccluder_m2 = 0.4f;  // of what hides other blocks

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

struct Triangle {
  int group;
  std::array<uint32_t, 3> corners;
};

void AppendVertices(const PackPrimitive& p, const Mat4& world, const Vec4& base, int layer,
                    std::vector<TownVertex>* vertices) {
  const Mat4 inverse = Inverse(world);
  for (size_t i = 0; i < p.positions.size(); ++i) {
    const Vec3 n = TurnNormal(inverse, p.normals[i]);
    const Vec4 c = p.colors.empty() ? Vec4{1, 1, 1, 1} : p.colors[i];
    vertices->push_back({TransformPoint(world, p.positions[i]),
                         {SignedByte(n.x), SignedByte(n.y), SignedByte(n.z), static_cast<int8_t>(layer)},
                         p.uvs.empty() ? Vec2{} : p.uvs[i],
                         {SrgbByte(c.x * base.x), SrgbByte(c.y * base.y), SrgbByte(c.z * base.z), Byte(c.w * base.w)}});
  }
}

// A block's place on a curve that keeps neighbours together (Morton's).
uint64_t CellOf(const std::array<uint32_t, 3>& corners, const TownGeometry& town) {
  Vec3 sum;
  for (uint32_t c : corners) sum = sum + town.vertices[c].position;
  const auto spread = [](float meters) {
    constexpr float kMiddle = 32768;  // blocks before zero
    const auto cell = static_cast<uint64_t>(std::clamp(std::floor(meters / 3 / kBlock_m) + kMiddle, 0.0f, 65535.0f));
    uint64_t bits = 0;
    for (unsigned i = 0; i < 16; ++i) bits |= (cell >> i & 1) << (3 * i);
    return bits;
  };
  return spread(sum.x) | spread(sum.z) << 1 | spread(sum.y) << 2;
}

bool HidesWhatIsBehind(const Triangle& t, const SurfacePlan& plan, const std::vector<TownVertex>& vertices) {
  if (plan.groups[static_cast<size_t>(t.group)].masked) return false;
  const Vec3 a = vertices[t.corners[0]].position, b = vertices[t.corners[1]].position,
             c = vertices[t.corners[2]].position;
  return Length(Cross(b - a, c - a)) / 2 > kMinOccluder_m2;
}

// Behind the opaque ones, so that a block's ranges are where the index array has them in the end.
void AppendMasked(const std::vector<std::vector<uint32_t>>& masked, TownGeometry* town) {
  std::vector<uint32_t> first(masked.size());
  for (size_t g = 0; g < masked.size(); ++g) {
    first[g] = static_cast<uint32_t>(town->indices.size());
    town->indices.insert(town->indices.end(), masked[g].begin(), masked[g].end());
  }
  for (TownBlock& block : town->blocks) {
    for (TownRange& range : block.ranges) {
      const auto g = static_cast<size_t>(range.group);
      if (!masked[g].empty()) range.first += first[g];
    }
  }
}

Vec4 BaseColor(const TourPack& pack, int material) {
  return material >= 0 ? pack.materials[static_cast<size_t>(material)].base_color : Vec4{1, 1, 1, 1};
}

TurningGeometry BuildTurning(const TourPack& pack, const SurfacePlan& plan, const TownInstance& instance) {
  TurningGeometry out;
  out.index = instance.turning;
  out.part = pack.turning[static_cast<size_t>(instance.turning)];
  const bool mirrored = Mirrors(instance.world);
  for (const PackPrimitive& p : pack.meshes[static_cast<size_t>(instance.mesh)].primitives) {
    const auto base = static_cast<uint32_t>(out.vertices.size());
    const Surface& surface = SurfaceOf(p.material, plan);
    AppendVertices(p, instance.world, BaseColor(pack, p.material), surface.layer, &out.vertices);
    out.ranges.push_back(
        {surface.group, static_cast<uint32_t>(out.indices.size()), static_cast<uint32_t>(p.indices.size())});
    for (const uint32_t i : p.indices) out.indices.push_back(base + i);
    for (size_t i = out.ranges.back().first; mirrored && i + 2 < out.indices.size(); i += 3)
      std::swap(out.indices[i + 1], out.indices[i + 2]);
  }
  const Vec3 pivot = GltfFromGround(out.part.pivot_m);
  float reach_m = 0;
  for (const TownVertex& v : out.vertices) reach_m = std::max(reach_m, Length(v.position - pivot));
  const Vec3 reach{reach_m, reach_m, reach_m};
  out.box = {pivot - reach, pivot + reach};
  return out;
}

}  // namespace

// The index array in order of block and group; vertices in order of their first use, so that a block's lie together.
struct TownBuilder::Impl {
  const TourPack& pack;
  const SurfacePlan& plan;
  TownGeometry town;
  std::map<uint64_t, std::vector<Triangle>> cells;
  size_t next_instance = 0, next_primitive = 0;
  bool packs = false;  // all instances are in cells
  std::map<uint64_t, std::vector<Triangle>>::iterator next_cell;
  std::vector<TownVertex> all;                // as they came
  std::vector<uint32_t> place;                // of them in the town
  std::vector<std::vector<uint32_t>> masked;  // indices, by group

  Impl(const TourPack& of_pack, const SurfacePlan& of_plan) : pack(of_pack), plan(of_plan) {}
  void Reserve();
  size_t AppendNext();
  void BeginPacking();
  void Pack(std::vector<Triangle>* triangles);
  void Finish();
};

void TownBuilder::Impl::Reserve() {
  size_t vertices = 0;
  for (const TownInstance& instance : pack.town)
    for (const PackPrimitive& p : pack.meshes[static_cast<size_t>(instance.mesh)].primitives)
      vertices += p.positions.size();
  town.vertices.reserve(vertices);
}

// The next instance's next primitive. How many triangles it has.
size_t TownBuilder::Impl::AppendNext() {
  const TownInstance& instance = pack.town[next_instance];
  const std::vector<PackPrimitive>& primitives = At(pack.meshes, instance.mesh).primitives;
  const bool turns = instance.turning >= 0;
  if (turns) town.turning.push_back(BuildTurning(pack, plan, instance));
  if (turns || next_primitive >= primitives.size()) {
    ++next_instance;
    next_primitive = 0;
    return 0;
  }
  const PackPrimitive& p = primitives[next_primitive++];
  const bool mirrored = Mirrors(instance.world);
  const auto base = static_cast<uint32_t>(town.vertices.size());
  const Surface& surface = SurfaceOf(p.material, plan);
  AppendVertices(p, instance.world, BaseColor(pack, p.material), surface.layer, &town.vertices);
  for (size_t i = 0; i + 2 < p.indices.size(); i += 3) {
    Triangle t{surface.group, {base + p.indices[i], base + p.indices[i + 1], base + p.indices[i + 2]}};
    if (mirrored) std::swap(t.corners[1], t.corners[2]);
    cells[CellOf(t.corners, town)].push_back(t);
  }
  return p.indices.size() / 3;
}

void TownBuilder::Impl::BeginPacking() {
  packs = true;
  all = std::move(town.vertices);
  place.assign(all.size(), UINT32_MAX);
  masked.resize(plan.groups.size());
  size_t turning = 0;  // stand behind the others in one buffer, later
  for (const TurningGeometry& part : town.turning) turning += part.vertices.size();
  town.vertices.clear();
  town.vertices.reserve(all.size() + turning);
  town.positions.reserve(all.size());
  size_t count = 0;
  for (const auto& [cell, triangles] : cells) count += triangles.size();
  town.indices.reserve(3 * count);
  next_cell = cells.begin();
}

void TownBuilder::Impl::Pack(std::vector<Triangle>* triangles) {
  std::stable_sort(triangles->begin(), triangles->end(),
                   [](const Triangle& a, const Triangle& b) { return a.group < b.group; });
  TownBlock block;
  block.triangles = static_cast<int64_t>(triangles->size());
  block.first_wall = town.walls.size();
  for (const Triangle& t : *triangles) {
    const auto group = static_cast<size_t>(t.group);
    std::vector<uint32_t>& indices = plan.groups[group].masked ? masked[group] : town.indices;
    if (block.ranges.empty() || block.ranges.back().group != t.group) {
      block.ranges.push_back({t.group, static_cast<uint32_t>(indices.size()), 0});
    }
    for (uint32_t corner : t.corners) {
      if (place[corner] == UINT32_MAX) {
        place[corner] = static_cast<uint32_t>(town.vertices.size());
        town.vertices.push_back(all[corner]);
        town.positions.push_back(all[corner].position);
      }
      indices.push_back(place[corner]);
      Include(all[corner].position, &block.box);
    }
    block.ranges.back().count += 3;
    if (!HidesWhatIsBehind(t, plan, all)) continue;
    for (uint32_t corner : t.corners) town.walls.push_back(place[corner]);
    if (!plan.groups[group].double_sided) continue;
    for (const size_t k : {2u, 1u, 0u}) town.walls.push_back(place[t.corners[k]]);
  }
  block.walls = town.walls.size() - block.first_wall;
  block.ranges.shrink_to_fit();
  town.blocks.push_back(std::move(block));
}

void TownBuilder::Impl::Finish() {
  AppendMasked(masked, &town);
  town.walls.shrink_to_fit();
  town.blocks.shrink_to_fit();
}

TownBuilder::TownBuilder(const TourPack& pack, const SurfacePlan& plan) : impl_(std::make_unique<Impl>(pack, plan)) {
  impl_->Reserve();
}
TownBuilder::TownBuilder(TownBuilder&&) noexcept = default;
TownBuilder& TownBuilder::operator=(TownBuilder&&) noexcept = default;
TownBuilder::~TownBuilder() = default;

bool TownBuilder::Advance() {
  constexpr size_t kTrianglesAtOnce = 10000;  // a few milliseconds
  Impl& b = *impl_;
  size_t done = 0;
  while (b.next_instance < b.pack.town.size() && done < kTrianglesAtOnce) done += b.AppendNext();
  if (b.next_instance < b.pack.town.size()) return false;
  if (!b.packs) {
    b.BeginPacking();
    return false;
  }
  for (; b.next_cell != b.cells.end() && done < kTrianglesAtOnce; ++b.next_cell) {
    b.Pack(&b.next_cell->second);
    done += b.next_cell->second.size();
  }
  if (b.next_cell != b.cells.end()) return false;
  b.Finish();
  return true;
}

TownGeometry TownBuilder::Take() { return std::move(impl_->town); }

TownGeometry BuildTownGeometry(const TourPack& pack, const SurfacePlan& plan) {
  TownBuilder builder(pack, plan);
  while (!builder.Advance()) {}
  return builder.Take();
}

}  // namespace flaneur
