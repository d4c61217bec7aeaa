#include "pipeline/io/encode_avatar.h"

#include <algorithm>
#include <cmath>

#include "pipeline/io/mesh_pieces.h"
#include "runtime/base/array.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

constexpr float kKeyError_m = 0.001f;   // by which a clip's rounding may move any vertex
constexpr int kManyTriangles = 30000;   // whose closest compression takes longer than all the rest
constexpr float kRoundedShare = 0.02f;  // of a level's error, that a position may be rounded by

PositionGrid GridAround(std::span<const Mesh> parts) {
  Vec3 min{1e30f, 1e30f, 1e30f}, max{-1e30f, -1e30f, -1e30f};
  for (const Mesh& mesh : parts) {
    for (const uint32_t i : mesh.indices) {
      const Vec3 p = mesh.positions[i];
      min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
      max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
    }
  }
  const Vec3 size = max - min;
  const float largest = std::max({size.x, size.y, size.z});
  return {min, largest > 0 ? largest : 1.0f};
}

Error CheckPart(const Mesh& mesh) {
  const size_t n = mesh.positions.size();
  const auto fits = [n](size_t size) { return size == 0 || size == n; };
  if (!fits(mesh.normals.size()) || !fits(mesh.uvs.size()) || !fits(mesh.uvs1.size()) || !fits(mesh.colors.size()) ||
      !fits(mesh.joints.size()) || !fits(mesh.weights.size())) {
    return Fail("an attribute has not one value a vertex");
  }
  if (mesh.indices.size() % 3 != 0) return Fail("its indices are not triangles");
  for (const uint32_t i : mesh.indices) {
    if (i >= n) return Fail("an index is out of range");
  }
  return Ok();
}

// The triangles with only the vertices that they use, in order of first use.
Mesh Compact(const Mesh& in, std::span<const uint32_t> triangles) {
  std::vector<uint32_t> to(in.positions.size(), 0xffffffffu), from;
  Mesh out;
  out.material = in.material;
  for (const uint32_t i : triangles) {
    if (to[i] == 0xffffffffu) {
      to[i] = static_cast<uint32_t>(from.size());
      from.push_back(i);
    }
    out.indices.push_back(to[i]);
  }
  const auto gather = [&from](const auto& values, auto* result) {
    if (values.empty()) return;
    for (const uint32_t i : from) result->push_back(values[i]);
  };
  gather(in.positions, &out.positions);
  gather(in.normals, &out.normals);
  gather(in.uvs, &out.uvs);
  gather(in.uvs1, &out.uvs1);
  gather(in.colors, &out.colors);
  gather(in.joints, &out.joints);
  gather(in.weights, &out.weights);
  // glTF wants joint 0 where the weight, as it is stored, is 0.
  for (size_t v = 0; v < out.weights.size() && v < out.joints.size(); ++v) {
    const auto bytes = WeightBytes(out.weights[v]);
    for (size_t i = 0; i < 4; ++i) {
      if (bytes[i] == 0) out.joints[v][i] = 0;
    }
  }
  return out;
}

bool JointsFitBytes(std::span<const Mesh> parts) {
  for (const Mesh& mesh : parts) {
    for (const auto& joints : mesh.joints) {
      if (*std::max_element(joints.begin(), joints.end()) > 255) return false;
    }
  }
  return true;
}

// Rounding stays well below the level's own error.
int PositionBits(const AvatarLevel& level, float height_m) {
  const float error_m = std::max(level.error_mm, level.posed_error_mm) / 1000;
  if (!(error_m > 0)) return 0;
  const float bits = std::ceil(std::log2(height_m / (kRoundedShare * error_m)));
  return static_cast<int>(std::clamp(bits, 12.0f, 16.0f));
}

// Without the uvs of materials that have no picture.
std::vector<Mesh> WithoutIdleUvs(std::vector<Mesh> meshes, const std::vector<Material>& materials) {
  for (Mesh& mesh : meshes) {
    const Material* material = mesh.material >= 0 ? &At(materials, mesh.material) : nullptr;
    const bool pictured = material != nullptr && (material->base_color_image >= 0 || material->normal_image >= 0);
    if (pictured) continue;
    mesh.uvs.clear();
    mesh.uvs1.clear();
  }
  return meshes;
}

Error EncodeLevel(const Avatar& avatar, const AvatarLevel& level, DracoOptions draco, EncodedMesh* encoded) {
  if (draco.position_bits == 0) draco.position_bits = PositionBits(level, avatar.height_m);
  if (level.triangles > kManyTriangles) draco.speed = std::max(draco.speed, 2);
  return EncodeMesh(WithoutIdleUvs(level.meshes, avatar.materials), draco, encoded);
}

}  // namespace

Error EncodeMesh(std::span<const Mesh> parts, const DracoOptions& draco, EncodedMesh* encoded) {
  *encoded = {};
  for (const Mesh& part : parts) {
    if (Error e = CheckPart(part)) return e;
  }
  const PositionGrid grid = GridAround(parts);
  encoded->compressed = draco.compress;
  encoded->byte_joints = JointsFitBytes(parts);
  for (const Mesh& part : parts) {
    if (part.indices.empty()) continue;
    for (const std::vector<uint32_t>& piece : InPieces(part, draco.most_triangles)) {
      EncodedPart& to = encoded->parts.emplace_back();
      to.material = part.material;
      to.mesh = Compact(part, piece);
      if (!draco.compress) continue;
      if (Error e = EncodeDraco(to.mesh, draco, grid, encoded->byte_joints, &to.draco)) return e;
      to.mesh = {};
    }
  }
  return Ok();
}

Error EncodeAvatar(const AvatarLevels& levels, const DracoOptions& draco, Jobs* jobs, EncodedAvatar* encoded) {
  const Avatar& avatar = levels.avatar;
  const size_t level_count = levels.levels.size(), prop_count = avatar.props.size(), clip_count = avatar.clips.size();
  *encoded = {std::vector<EncodedMesh>(level_count), std::vector<EncodedMesh>(prop_count),
              std::vector<std::vector<KeyChannel>>(clip_count)};
  std::vector<Mesh> moved;  // that tell how exact a clip must be
  if (level_count > 0) moved = levels.levels[0].meshes;
  for (const AvatarProp& prop : avatar.props) moved.insert(moved.end(), prop.meshes.begin(), prop.meshes.end());
  std::vector<Error> errors(level_count + prop_count);
  ParallelFor(jobs, errors.size() + clip_count, [&](size_t i) {
    if (i < level_count) {
      errors[i] = EncodeLevel(avatar, levels.levels[i], draco, &encoded->levels[i]);
    } else if (i < errors.size()) {
      const size_t k = i - level_count;
      errors[i] = EncodeMesh(WithoutIdleUvs(avatar.props[k].meshes, avatar.materials), draco, &encoded->props[k]);
    } else {
      const size_t c = i - errors.size();
      const Clip& clip = avatar.clips[c];
      encoded->clips[c] =
          draco.compress ? ReduceKeysTogether(clip, avatar.joints, moved, kKeyError_m) : AllKeys(clip, avatar.joints);
    }
  });
  for (size_t i = 0; i < errors.size(); ++i) {
    const std::string name = i < level_count ? "level" + std::to_string(i) : avatar.props[i - level_count].name;
    if (errors[i]) return Fail("mesh '" + OneLine(name) + "': " + errors[i].message);
  }
  return Ok();
}

}  // namespace flaneur
