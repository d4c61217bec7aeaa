#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "pipeline/io/encode_avatar.h"
#include "pipeline/io/gltf.h"
#include "pipeline/io/gltf_builder.h"
#include "runtime/base/array.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

// MSFT_lod's thresholds are shares of the screen's height; ours are pixels, taken on a screen this
// high.
constexpr float kScreenHeight_px = 1080;
std::string LevelExtras(const AvatarLevel& level) {
  const nlohmann::json extras = {{"flaneur_triangles", level.triangles},
                                 {"flaneur_error_mm", level.error_mm},
                                 {"flaneur_posed_error_mm", level.posed_error_mm},
                                 {"flaneur_switch_px", level.switch_px}};
  return extras.dump();
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

Error AddAvatar(GltfBuilder* builder, const AvatarLevels& levels, const EncodedAvatar& encoded,
                const std::string& prefix, AvatarPart* part) {
  const Avatar& avatar = levels.avatar;
  *part = {};
  AddSkeleton(builder, avatar, prefix, part);
  const std::vector<int>& materials = part->materials = builder->AddMaterials(avatar.materials, avatar.images);
  for (size_t c = 0; c < avatar.clips.size(); ++c) {
    part->animations.push_back(
        builder->AddAnimation(prefix + avatar.clips[c].name, encoded.clips[c], part->joint_nodes));
  }
  std::vector<float> switch_shares;
  for (size_t k = 0; k < levels.levels.size(); ++k) {
    GltfNode node;
    node.name = prefix + "level" + std::to_string(k);
    node.skin = part->skin;
    node.extras = LevelExtras(levels.levels[k]);
    if (Error e = builder->AddMesh(node.name, encoded.levels[k], materials, &node.mesh)) return e;
    part->level_nodes.push_back(builder->AddNode(node));
    switch_shares.push_back(std::min(levels.levels[k].switch_px / kScreenHeight_px, 1.0f));
  }
  for (size_t k = 0; k < avatar.props.size(); ++k) {
    GltfNode node;
    node.name = prefix + avatar.props[k].name;
    node.skin = part->skin;
    if (Error e = builder->AddMesh(node.name, encoded.props[k], materials, &node.mesh)) return e;
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
  EncodedAvatar encoded;
  if (Error e = EncodeAvatar(levels, draco, jobs, &encoded)) return Fail(path.string() + ": " + e.message);
  if (Error e = AddAvatar(&builder, levels, encoded, "", &part)) return Fail(path.string() + ": " + e.message);
  std::vector<int> roots{part.level_nodes[0], part.skeleton_node};
  roots.insert(roots.end(), part.prop_nodes.begin(), part.prop_nodes.end());
  builder.AddScene(levels.avatar.name, roots);
  std::vector<uint8_t> glb;
  if (Error e = builder.Finish(&glb)) return Fail(path.string() + ": " + e.message);
  return WriteFile(path, glb);
}

}  // namespace flaneur
