#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "pipeline/io/gltf.h"
#include "pipeline/io/gltf_builder.h"
#include "runtime/base/array.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

// MSFT_lod's thresholds are shares of the screen's height; ours are pixels, taken on a screen this
// high.
constexpr float kScreenHeight_px = 1080;
constexpr int kManyTriangles = 30000;   // whose closest compression takes longer than all the rest
constexpr float kRoundedShare = 0.02f;  // of a level's error, that a position may be rounded by

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

std::string LevelExtras(const AvatarLevel& level) {
  const nlohmann::json extras = {{"flaneur_triangles", level.triangles},
                                 {"flaneur_error_mm", level.error_mm},
                                 {"flaneur_posed_error_mm", level.posed_error_mm},
                                 {"flaneur_switch_px", level.switch_px}};
  return extras.dump();
}

std::shared_ptr<const EncodedMesh> EncodedLevel(const Avatar& avatar, const AvatarLevel& level, DracoOptions draco) {
  if (draco.position_bits == 0) draco.position_bits = PositionBits(level, avatar.height_m);
  if (level.triangles > kManyTriangles) draco.speed = std::max(draco.speed, 2);
  return EncodeMesh(WithoutIdleUvs(level.meshes, avatar.materials), draco);
}

void AddSkeleton(GltfBuilder* builder, const Avatar& avatar, const std::string& prefix, AvatarPart* part) {
  GltfNode skeleton;
  skeleton.name = prefix + "skeleton";
  skeleton.extras = nlohmann::json{{"flaneur_walk_speed_mps", avatar.walk_speed_mps}}.dump();
  part->skeleton_node = builder->AddNode(skeleton);
  std::vector<Mat4> inverse_binds;
  for (const Joint& joint : avatar.joints) {
    GltfNode node;
    node.name = prefix + joint.name;
    node.parent = joint.parent < 0 ? part->skeleton_node : At(part->joint_nodes, joint.parent);
    node.transform = joint.rest;
    part->joint_nodes.push_back(builder->AddNode(node));
    inverse_binds.push_back(joint.inverse_bind);
  }
  part->skin = builder->AddSkin(prefix + "skin", part->joint_nodes, inverse_binds, part->skeleton_node);
}

}  // namespace

Error AddAvatar(GltfBuilder* builder, const AvatarLevels& levels, const std::string& prefix, const DracoOptions& draco,
                Jobs* jobs, AvatarPart* part) {
  const Avatar& avatar = levels.avatar;
  *part = {};
  AddSkeleton(builder, avatar, prefix, part);
  const std::vector<int>& materials = part->materials = builder->AddMaterials(avatar.materials, avatar.images);
  std::vector<std::shared_ptr<const EncodedMesh>> meshes(levels.levels.size());
  ParallelFor(jobs, meshes.size(), [&](size_t k) { meshes[k] = EncodedLevel(avatar, levels.levels[k], draco); });
  std::vector<Mesh> moved = levels.levels[0].meshes;  // that tell how exact a clip must be
  for (const AvatarProp& prop : avatar.props) moved.insert(moved.end(), prop.meshes.begin(), prop.meshes.end());
  for (const Clip& clip : avatar.clips) {
    part->animations.push_back(
        builder->AddAnimation(prefix + clip.name, clip, avatar.joints, moved, part->joint_nodes, draco.compress));
  }
  std::vector<float> switch_shares;
  for (size_t k = 0; k < levels.levels.size(); ++k) {
    GltfNode node;
    node.name = prefix + "level" + std::to_string(k);
    node.skin = part->skin;
    node.extras = LevelExtras(levels.levels[k]);
    if (Error e = builder->AddMesh(node.name, *meshes[k], materials, &node.mesh)) return e;
    part->level_nodes.push_back(builder->AddNode(node));
    switch_shares.push_back(std::min(levels.levels[k].switch_px / kScreenHeight_px, 1.0f));
  }
  for (const AvatarProp& prop : avatar.props) {
    GltfNode node;
    node.name = prefix + prop.name;
    node.skin = part->skin;
    const auto mesh = EncodeMesh(WithoutIdleUvs(prop.meshes, avatar.materials), draco);
    if (Error e = builder->AddMesh(node.name, *mesh, materials, &node.mesh)) return e;
    part->prop_nodes.push_back(builder->AddNode(node));
  }
  if (part->level_nodes.size() > 1) {
    builder->SetLevels(part->level_nodes[0], std::span(part->level_nodes).subspan(1), switch_shares);
  }
  return Ok();
}

Error WriteAvatarGlb(const std::filesystem::path& path, const AvatarLevels& levels, const DracoOptions& draco,
                     Jobs* jobs) {
  GltfBuilder builder;
  AvatarPart part;
  if (Error e = AddAvatar(&builder, levels, "", draco, jobs, &part)) {
    return Fail(path.string() + ": " + e.message);
  }
  std::vector<int> roots{part.level_nodes[0], part.skeleton_node};
  roots.insert(roots.end(), part.prop_nodes.begin(), part.prop_nodes.end());
  builder.AddScene(levels.avatar.name, roots);
  std::vector<uint8_t> glb;
  if (Error e = builder.Finish(&glb)) return Fail(path.string() + ": " + e.message);
  return WriteFile(path, glb);
}

}  // namespace flaneur
