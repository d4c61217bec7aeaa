#include "pipeline/io/gltf_document.h"

#include <tiny_gltf.h>

#include <cmath>
#include <set>

#include "pipeline/io/gltf_accessor.h"
#include "pipeline/io/gltf_materials.h"
#include "pipeline/io/gltf_meshes.h"
#include "pipeline/io/gltf_names.h"
#include "pipeline/io/gltf_nodes.h"
#include "pipeline/io/gltf_number.h"
#include "pipeline/io/gltf_parse.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

using tinygltf::Model;
using tinygltf::Value;

// Extensions that this reader either understands or that change nothing about geometry and base
// colour.
const std::set<std::string> kKnownExtensions{"KHR_draco_mesh_compression",
                                             "EXT_meshopt_compression",
                                             "KHR_mesh_quantization",
                                             "KHR_texture_transform",
                                             "KHR_texture_basisu",
                                             "EXT_texture_webp",
                                             "EXT_mesh_gpu_instancing",
                                             "KHR_materials_pbrSpecularGlossiness",
                                             "KHR_materials_unlit",
                                             "KHR_materials_specular",
                                             "KHR_materials_ior",
                                             "KHR_materials_clearcoat",
                                             "KHR_materials_sheen",
                                             "KHR_materials_emissive_strength",
                                             "KHR_materials_variants",
                                             "KHR_materials_anisotropy",
                                             "KHR_materials_transmission",
                                             "KHR_materials_volume",
                                             "KHR_materials_iridescence",
                                             "KHR_materials_dispersion",
                                             "KHR_lights_punctual",
                                             "KHR_animation_pointer",
                                             "VRM",
                                             "VRMC_vrm",
                                             "VRMC_vrm_animation",
                                             "VRMC_materials_mtoon",
                                             "VRMC_materials_hdr_emissiveMultiplier",
                                             "VRMC_springBone",
                                             "VRMC_node_constraint",
                                             "MSFT_lod",
                                             "KHR_xmp_json_ld",
                                             "FLANEUR_tour"};

Error CheckExtensions(const Model& model) {
  for (const std::string& name : model.extensionsRequired) {
    if (kKnownExtensions.count(name) > 0) continue;
    return Fail("needs the extension " + OneLine(name) + ", which is not supported; export the file without it");
  }
  return Ok();
}

Error ReadSkin(const Model& model, const tinygltf::Skin& in, DocumentSkin* out) {
  out->joints = in.joints;
  if (in.joints.empty()) return Fail("it has no joints");
  for (const int joint : in.joints) {
    if (!InRange(model.nodes, joint)) {
      return Fail("joint " + std::to_string(joint) + " does not exist");
    }
  }
  out->inverse_binds.resize(in.joints.size());
  if (in.inverseBindMatrices < 0) return Ok();
  std::vector<float> values;
  if (Error e = ReadFloats(model, in.inverseBindMatrices, 16, &values)) return e;
  if (values.size() < 16 * in.joints.size()) return Fail("it has too few inverse bind matrices");
  for (size_t j = 0; j < in.joints.size(); ++j) {
    Mat4& matrix = out->inverse_binds[j];
    for (size_t i = 0; i < 16; ++i) matrix.m[i / 4][i % 4] = values[16 * j + i];
    if (!Finite(matrix)) return Fail("an inverse bind matrix is not finite");
  }
  return Ok();
}

Error ReadChannel(const Model& model, const tinygltf::Animation& animation, const tinygltf::AnimationChannel& in,
                  DocumentChannel* out) {
  if (!InRange(animation.samplers, in.sampler)) {
    return Fail("sampler " + std::to_string(in.sampler) + " does not exist");
  }
  const tinygltf::AnimationSampler& sampler = At(animation.samplers, in.sampler);
  out->node = in.target_node;
  out->path = in.target_path == "translation" ? ChannelPath::kTranslation
              : in.target_path == "rotation"  ? ChannelPath::kRotation
                                              : ChannelPath::kScale;
  if (sampler.interpolation == "STEP") out->interpolation = Interpolation::kStep;
  if (sampler.interpolation == "CUBICSPLINE") out->interpolation = Interpolation::kCubic;
  if (Error e = ReadFloats(model, sampler.input, 1, &out->times)) return e;
  const size_t width = out->path == ChannelPath::kRotation ? 4 : 3;
  std::vector<float> values;
  if (Error e = ReadFloats(model, sampler.output, static_cast<int>(width), &values)) return e;
  const size_t per_key = out->interpolation == Interpolation::kCubic ? 3 : 1;
  if (out->times.empty() || values.size() != width * per_key * out->times.size()) {
    return Fail("a channel has not one value a key");
  }
  out->values.resize(values.size() / width);
  for (size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) return Fail("a key is not finite");
    (&out->values[i / width].x)[i % width] = values[i];
  }
  for (size_t i = 0; i < out->times.size(); ++i) {
    if (!std::isfinite(out->times[i]) || (i > 0 && out->times[i] < out->times[i - 1])) {
      return Fail("the times of a channel do not rise");
    }
  }
  return Ok();
}

Error ReadClip(const Model& model, size_t index, DocumentClip* out) {
  const tinygltf::Animation& in = model.animations[index];
  out->name = NameOr(in.name, "animation", index);
  for (const tinygltf::AnimationChannel& channel : in.channels) {
    const bool moves_node =
        channel.target_path == "translation" || channel.target_path == "rotation" || channel.target_path == "scale";
    if (!moves_node || channel.target_node < 0) continue;
    if (static_cast<size_t>(channel.target_node) >= model.nodes.size()) {
      return Fail("node " + std::to_string(channel.target_node) + " does not exist");
    }
    DocumentChannel read;
    if (Error e = ReadChannel(model, in, channel, &read)) return e;
    out->channels.push_back(std::move(read));
  }
  return Ok();
}

// VRM's own names ("leftUpperArm") read as any others.
void AddBone(const std::string& name, const Value& node, GltfDocument* document) {
  const BoneName bone = ReadBoneName(name);
  if (bone.part == BodyPart::kNone || !InRange(document->nodes, IndexOf(node))) return;
  document->bones.push_back({IndexOf(node), bone.part, bone.side});
}

void ReadBones(const Model& model, GltfDocument* document) {
  for (const char* name : {"VRM", "VRMC_vrm", "VRMC_vrm_animation"}) {
    const auto found = model.extensions.find(name);
    if (found == model.extensions.end() || !found->second.IsObject() || !found->second.Has("humanoid")) continue;
    const Value& humanoid = found->second.Get("humanoid");
    if (!humanoid.IsObject() || !humanoid.Has("humanBones")) continue;
    const Value& bones = humanoid.Get("humanBones");
    for (size_t i = 0; bones.IsArray() && i < bones.ArrayLen(); ++i) {
      const Value& bone = bones.Get(static_cast<int>(i));
      if (bone.IsObject() && bone.Has("bone") && bone.Get("bone").IsString() && bone.Has("node"))
        AddBone(bone.Get("bone").Get<std::string>(), bone.Get("node"), document);
    }
    for (const std::string& key : bones.IsObject() ? bones.Keys() : std::vector<std::string>{}) {
      const Value& bone = bones.Get(key);
      if (bone.IsObject() && bone.Has("node")) AddBone(key, bone.Get("node"), document);
    }
  }
}

Error ReadModel(const Model& model, GltfDocument* document, std::vector<std::string>* warnings) {
  std::vector<UvSource> uv_sources;
  if (Error e = CheckExtensions(model)) return e;
  if (Error e = ReadNodes(model, document)) return e;
  ReadBones(model, document);
  if (Error e = ReadMaterials(model, document, &uv_sources, warnings)) return e;
  if (Error e = ReadMeshes(model, uv_sources, document)) return e;
  document->skins.resize(model.skins.size());
  for (size_t i = 0; i < model.skins.size(); ++i) {
    if (Error e = ReadSkin(model, model.skins[i], &document->skins[i])) {
      return Fail("skin " + std::to_string(i) + ": " + e.message);
    }
    if (model.skins[i].inverseBindMatrices < 0) {
      warnings->push_back("skin " + Quoted(NameOr(model.skins[i].name, "skin", i)) +
                          " has no inverse bind matrices: where the figure comes apart, export it anew with them");
    }
  }
  for (size_t i = 0; i < model.animations.size(); ++i) {
    DocumentClip clip;
    if (Error e = ReadClip(model, i, &clip)) return Fail("clip " + Quoted(clip.name) + ": " + e.message);
    if (!clip.channels.empty()) document->clips.push_back(std::move(clip));  // else it moves morph targets alone
  }
  return Ok();
}

}  // namespace

std::vector<int> DepthFirst(const std::vector<int>& roots, const std::vector<std::vector<int>>& children_of) {
  std::vector<int> stack(roots.rbegin(), roots.rend()), order;
  while (!stack.empty()) {
    const int node = stack.back();
    stack.pop_back();
    order.push_back(node);
    const auto& children = At(children_of, node);
    stack.insert(stack.end(), children.rbegin(), children.rend());
  }
  return order;
}

Mat4 LocalMatrix(const DocumentNode& node) {
  if (node.has_matrix) return node.matrix;
  return FromTranslationRotationScale(node.translation, node.rotation, node.scale);
}

std::vector<Mat4> WorldMatrices(const GltfDocument& document) {
  std::vector<Mat4> world(document.nodes.size());
  for (const int i : document.order) {
    const DocumentNode& node = At(document.nodes, i);
    const Mat4 local = LocalMatrix(node);
    At(world, i) = node.parent < 0 ? local : At(world, node.parent) * local;
  }
  return world;
}

Error LoadGltf(const std::filesystem::path& path, GltfDocument* document, std::vector<std::string>* warnings,
               const std::filesystem::path& named) {
  *document = {};
  document->path = (named.empty() ? path : named).string();
  Model model;
  if (Error e = ParseGltf(path, &model)) return e;
  std::vector<std::string> notes;
  Error error;
  try {
    error = ReadModel(model, document, &notes);
  } catch (const std::exception& e) {
    error = Fail(e.what());
  }
  if (error) return Fail(document->path + ": " + error.message);
  for (const std::string& note : notes) warnings->push_back(document->path + ": " + note);
  return Ok();
}

}  // namespace flaneur
