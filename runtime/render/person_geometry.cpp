#include "runtime/render/person_geometry.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "runtime/render/projection.h"
#include "runtime/render/vertex_bytes.h"

namespace flaneur {
namespace {

constexpr float kLargerCells = 1.2f;
constexpr size_t kTrianglesOfLimb = 4;
constexpr float kThinLimb = 0.6f;       // of a cell: nothing would be left of it
constexpr float kLimbToBreadth = 1.3f;  // a limb is longer than broad by so much

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

// All that hangs on one joint, where it is longer than broad: a shin, an upper arm. In the rest pose.
struct Limb {
  Vec3 low, high;      // the ends of its axis
  Vec3 side, forward;  // half as broad as it is
  std::vector<uint32_t> vertices;
};

float AreaOf(const Limb& limb) {
  return Length(limb.high - limb.low) * std::max(Length(limb.side), Length(limb.forward));
}

// The least and the most of what lies along a direction.
std::pair<float, float> Reach(const PersonGeometry& of, const std::vector<uint32_t>& vertices, Vec3 direction) {
  std::pair<float, float> reach{1e9f, -1e9f};
  for (const uint32_t i : vertices) {
    const float at = Dot(of.vertices[i].position, direction);
    reach = {std::min(reach.first, at), std::max(reach.second, at)};
  }
  return reach;
}

// Along which they reach farthest, by power iteration on their covariance.
Vec3 AxisOf(const PersonGeometry& of, const std::vector<uint32_t>& vertices) {
  Vec3 middle, axis{0.1f, 1, 0.2f};
  for (const uint32_t i : vertices)
    middle = middle + of.vertices[i].position * (1 / static_cast<float>(vertices.size()));
  for (int round = 0; round < 8; ++round) {
    Vec3 sum;
    for (const uint32_t i : vertices) {
      const Vec3 p = of.vertices[i].position - middle;
      sum = sum + p * Dot(p, axis);
    }
    axis = Normalized(sum);
  }
  return axis;
}

std::optional<Limb> LimbOf(const PersonGeometry& of, std::vector<uint32_t> vertices, float thinner_m) {
  const Vec3 axis = AxisOf(of, vertices);
  const Vec3 side = Normalized(Cross(axis, std::abs(axis.y) < 0.9f ? Vec3{0, 1, 0} : Vec3{0, 0, 1}));
  const Vec3 forward = Cross(axis, side);
  const auto [low, high] = Reach(of, vertices, axis);
  const auto [left, right] = Reach(of, vertices, side);
  const auto [back, front] = Reach(of, vertices, forward);
  const float broad_m = std::max(right - left, front - back);
  if (!(broad_m > 0 && broad_m < thinner_m && high - low > kLimbToBreadth * broad_m)) return std::nullopt;
  const Vec3 middle = side * ((left + right) / 2) + forward * ((back + front) / 2);
  return Limb{middle + axis * low, middle + axis * high, side * ((right - left) / 2), forward * ((front - back) / 2),
              std::move(vertices)};
}

// The largest of them.
std::vector<Limb> LimbsOf(const PersonGeometry& of, float thinner_m, size_t most) {
  std::map<uint16_t, std::vector<uint32_t>> by_joint;
  for (uint32_t i = 0; i < of.vertices.size(); ++i) by_joint[OnHeaviestJoint(of.vertices[i]).joints[0]].push_back(i);
  std::vector<Limb> limbs;
  for (auto& [_, vertices] : by_joint)
    if (std::optional<Limb> limb = LimbOf(of, std::move(vertices), thinner_m)) limbs.push_back(std::move(*limb));
  std::sort(limbs.begin(), limbs.end(), [](const Limb& a, const Limb& b) { return AreaOf(a) > AreaOf(b); });
  if (limbs.size() > most) limbs.erase(limbs.begin() + static_cast<std::ptrdiff_t>(most), limbs.end());
  return limbs;
}

PersonGeometry Without(const std::vector<Limb>& limbs, PersonGeometry of) {
  std::vector<bool> of_limb(of.vertices.size(), false);
  for (const Limb& limb : limbs)
    for (const uint32_t i : limb.vertices) of_limb[i] = true;
  std::vector<uint32_t> kept;
  for (size_t i = 0; i + 2 < of.indices.size(); i += 3) {
    const uint32_t* t = &of.indices[i];
    if (!(of_limb[t[0]] && of_limb[t[1]] && of_limb[t[2]])) kept.insert(kept.end(), t, t + 3);
  }
  of.indices = std::move(kept);
  return of;
}

// As two strips that cross, which are broad from wherever the sun shines.
void Append(const Limb& limb, const PersonGeometry& of, PersonGeometry* out) {
  PersonVertex v = OnHeaviestJoint(of.vertices[limb.vertices[0]]);
  for (const Vec3 half : {limb.side, limb.forward}) {
    const auto first = static_cast<uint32_t>(out->vertices.size());
    for (const Vec3 corner : {limb.low - half, limb.low + half, limb.high - half, limb.high + half})
      v.position = corner, out->vertices.push_back(v);
    for (const uint32_t k : {0u, 1u, 2u, 1u, 2u, 3u}) out->indices.push_back(first + k);
  }
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
  most_triangles = std::min(most_triangles, of.indices.size() / 3);
  const std::vector<Limb> limbs = LimbsOf(of, kThinLimb * cell_m, most_triangles / 2 / kTrianglesOfLimb);
  const PersonGeometry others = Without(limbs, of);
  PersonGeometry out = WithinCells(others, cell_m);
  while (out.indices.size() / 3 + kTrianglesOfLimb * limbs.size() > most_triangles)
    out = WithinCells(others, cell_m *= kLargerCells);
  for (const Limb& limb : limbs) Append(limb, of, &out);
  out.ranges = {{0, 0, static_cast<uint32_t>(out.indices.size())}};
  return out;
}

}  // namespace flaneur
