#include "pipeline/io/gltf_document.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "pipeline/io/basis_picture.h"
#include "pipeline/io/draco_codec.h"
#include "pipeline/io/face_targets.h"
#include "pipeline/io/gltf_accessor.h"
#include "pipeline/io/gltf_instancing.h"
#include "pipeline/io/gltf_number.h"
#include "pipeline/io/gltf_parse.h"
#include "pipeline/io/gltf_primitive.h"
#include "pipeline/io/webp_picture.h"
#include "runtime/base/array.h"
#include "runtime/base/limits.h"
#include "runtime/base/png.h"
#include "runtime/base/text.h"

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

std::string Quoted(const std::string& name) { return "'" + OneLine(name) + "'"; }

std::string NameOr(const std::string& name, const char* kind, size_t index) {
  return name.empty() ? std::string(kind) + " " + std::to_string(index) : name;
}

Error CheckExtensions(const Model& model) {
  for (const std::string& name : model.extensionsRequired) {
    if (kKnownExtensions.count(name) > 0) continue;
    return Fail("needs the extension " + OneLine(name) + ", which is not supported; export the file without it");
  }
  return Ok();
}

Error ReadNumberTag(const Value& extras, const char* key, float* value) {
  if (!extras.Has(key)) return Ok();
  if (!extras.Get(key).IsNumber()) return Fail(std::string(key) + " must be a number");
  *value = static_cast<float>(extras.Get(key).GetNumberAsDouble());
  return std::isfinite(*value) && *value >= 0 ? Ok() : Fail(std::string(key) + " is out of range");
}

Error ReadTextTag(const Value& extras, const char* key, std::string* value) {
  if (!extras.Has(key)) return Ok();
  if (!extras.Get(key).IsString()) return Fail(std::string(key) + " must be a string");
  *value = extras.Get(key).Get<std::string>();
  return Ok();
}

Error ReadTags(const Value& extras, NodeTags* tags) {
  if (!extras.IsObject()) return Ok();
  if (Error e = ReadTextTag(extras, "flaneur_kind", &tags->kind)) return e;
  if (Error e = ReadTextTag(extras, "flaneur_ground", &tags->ground)) return e;
  if (Error e = ReadTextTag(extras, "flaneur_street", &tags->street)) return e;
  if (Error e = ReadTextTag(extras, "flaneur_clip", &tags->clip)) return e;
  if (Error e = ReadTextTag(extras, "flaneur_turns", &tags->turns)) return e;
  if (Error e = ReadTextTag(extras, "flaneur_avatars", &tags->avatars)) return e;
  if (Error e = ReadNumberTag(extras, "flaneur_seat_m", &tags->seat_m)) return e;
  if (Error e = ReadNumberTag(extras, "flaneur_stay_s", &tags->stay_s)) return e;
  if (Error e = ReadNumberTag(extras, "flaneur_radius_m", &tags->radius_m)) return e;
  if (Error e = ReadNumberTag(extras, "flaneur_width_m", &tags->width_m)) return e;
  return ReadNumberTag(extras, "flaneur_walk_speed_mps", &tags->walk_speed_mps);
}

void ReadTransform(const tinygltf::Node& in, DocumentNode* out) {
  const auto f = [](double v) { return static_cast<float>(v); };
  if (in.translation.size() == 3) {
    out->translation = {f(in.translation[0]), f(in.translation[1]), f(in.translation[2])};
  }
  if (in.rotation.size() == 4) {
    out->rotation = Normalized(Quat{f(in.rotation[0]), f(in.rotation[1]), f(in.rotation[2]), f(in.rotation[3])});
  }
  if (in.scale.size() == 3) out->scale = {f(in.scale[0]), f(in.scale[1]), f(in.scale[2])};
  if (in.matrix.size() == 16) {
    out->has_matrix = true;
    for (size_t i = 0; i < 16; ++i) out->matrix.m[i / 4][i % 4] = f(in.matrix[i]);
  }
}

bool Finite(const Mat4& matrix) {
  for (const auto& column : matrix.m) {
    for (const float v : column) {
      if (!std::isfinite(v)) return false;
    }
  }
  return true;
}

Error ReadNode(const Model& model, size_t index, DocumentNode* out) {
  const tinygltf::Node& in = model.nodes[index];
  out->name = NameOr(in.name, "node", index);
  out->mesh = in.mesh;
  out->skin = in.skin;
  ReadTransform(in, out);
  if (!Finite(LocalMatrix(*out))) return Fail("its transform is not finite");
  if (in.mesh >= Count(model.meshes)) {
    return Fail("mesh " + std::to_string(in.mesh) + " does not exist");
  }
  if (in.skin >= Count(model.skins)) {
    return Fail("skin " + std::to_string(in.skin) + " does not exist");
  }
  return ReadTags(in.extras, &out->tags);
}

Error LinkNodes(const Model& model, GltfDocument* document) {
  const int count = Count(document->nodes);
  for (int i = 0; i < count; ++i) {
    for (const int child : At(model.nodes, i).children) {
      if (child < 0 || child >= count) {
        return Fail("node " + Quoted(At(document->nodes, i).name) + ": child " + std::to_string(child) +
                    " does not exist");
      }
      DocumentNode& node = At(document->nodes, child);
      if (node.parent >= 0 || child == i) {
        return Fail("node " + Quoted(node.name) + " has two parents");
      }
      node.parent = i;
    }
  }
  return Ok();
}

// Programs that compress a file hang a node's mesh on a nameless child with the quantized mesh's transform.
void NameAsParents(const Model& model, GltfDocument* document) {
  for (size_t i = 0; i < model.nodes.size(); ++i) {
    DocumentNode& node = document->nodes[i];
    if (!model.nodes[i].name.empty() || node.mesh < 0 || node.parent < 0) continue;
    const DocumentNode& parent = At(document->nodes, node.parent);
    if (parent.mesh < 0 && !At(model.nodes, node.parent).name.empty()) node.name = parent.name;
  }
}

// Depth first from the roots; nodes in a ring are never reached.
Error OrderNodes(const Model& model, GltfDocument* document) {
  std::vector<std::vector<int>> children_of;
  for (const tinygltf::Node& node : model.nodes) children_of.push_back(node.children);
  children_of.resize(document->nodes.size());
  for (int i = Count(model.nodes); i < Count(document->nodes); ++i)
    At(children_of, At(document->nodes, i).parent).push_back(i);
  std::vector<int> stack;
  for (int i = Count(document->nodes) - 1; i >= 0; --i) {
    if (At(document->nodes, i).parent < 0) stack.push_back(i);
  }
  while (!stack.empty()) {
    const int node = stack.back();
    stack.pop_back();
    document->order.push_back(node);
    const auto& children = At(children_of, node);
    stack.insert(stack.end(), children.rbegin(), children.rend());
  }
  if (document->order.size() != document->nodes.size()) return Fail("its nodes form a ring");
  return Ok();
}

// Coarser levels that MSFT_lod names stand beside the scene, also where the file has no scene.
std::set<int> CoarserLevels(const Model& model) {
  std::set<int> nodes;
  for (const tinygltf::Node& node : model.nodes) {
    const auto lod = node.extensions.find("MSFT_lod");
    if (lod == node.extensions.end() || !lod->second.Has("ids")) continue;
    const Value& ids = lod->second.Get("ids");
    const int count = ids.IsArray() ? static_cast<int>(ids.ArrayLen()) : 0;
    for (int i = 0; i < count; ++i) {
      if (ids.Get(i).IsNumber()) nodes.insert(IndexOf(ids.Get(i)));
    }
  }
  return nodes;
}

void MarkScene(const Model& model, GltfDocument* document) {
  const size_t scene = model.defaultScene >= 0 ? static_cast<size_t>(model.defaultScene) : 0;
  if (scene < model.scenes.size()) {
    for (const int root : model.scenes[scene].nodes) {
      if (InRange(document->nodes, root)) {
        At(document->nodes, root).in_scene = true;
      }
    }
  } else {
    for (DocumentNode& node : document->nodes) node.in_scene = node.parent < 0;
    for (const int i : CoarserLevels(model)) {
      if (InRange(document->nodes, i)) {
        At(document->nodes, i).in_scene = false;
      }
    }
  }
  for (const int i : document->order) {
    DocumentNode& node = At(document->nodes, i);
    if (node.parent >= 0) {
      node.in_scene = node.in_scene || At(document->nodes, node.parent).in_scene;
    }
  }
}

Error ReadNodes(const Model& model, GltfDocument* document) {
  document->nodes.resize(model.nodes.size());
  for (size_t i = 0; i < model.nodes.size(); ++i) {
    if (Error e = ReadNode(model, i, &document->nodes[i])) {
      return Fail("node " + Quoted(document->nodes[i].name) + ": " + e.message);
    }
  }
  if (Error e = LinkNodes(model, document)) return e;
  NameAsParents(model, document);
  if (Error e = SpreadInstances(model, document)) return e;
  if (Error e = OrderNodes(model, document)) return e;
  MarkScene(model, document);
  return Ok();
}

// Images: those in use are copied once.
class ImageTable {
 public:
  ImageTable(const Model& model, GltfDocument* document)
      : model_(model), document_(document), index_(model.images.size(), -1) {}

  // The document's image behind a texture of the file; -1 where there is none.
  Error Use(int texture, int* image) {
    *image = -1;
    if (texture < 0) return Ok();
    if (static_cast<size_t>(texture) >= model_.textures.size()) {
      return Fail("texture " + std::to_string(texture) + " does not exist");
    }
    const int source = SourceOf(At(model_.textures, texture));
    if (source < 0) return Fail("texture " + std::to_string(texture) + " has no PNG, JPEG, WebP or KTX2 image");
    if (static_cast<size_t>(source) >= model_.images.size()) {
      return Fail("image " + std::to_string(source) + " does not exist");
    }
    int& index = At(index_, source);
    if (index < 0) {
      Image copy;
      if (Error e = Copy(static_cast<size_t>(source), &copy)) return e;
      index = Count(document_->images);
      document_->images.push_back(std::move(copy));
    }
    *image = index;
    return Ok();
  }

 private:
  // PNG or JPEG where the file has another besides.
  static int SourceOf(const tinygltf::Texture& texture) {
    for (const char* name : {"KHR_texture_basisu", "EXT_texture_webp"}) {
      const auto other = texture.extensions.find(name);
      if (texture.source < 0 && other != texture.extensions.end() && other->second.Has("source"))
        return IndexOf(other->second.Get("source"));
    }
    return texture.source;
  }

  // As PNG, which all that follows reads.
  Error Unpack(Image* image) {
    pixels_left_ += kPixelsAByte * image->bytes.size();
    Pixels pixels;
    if (Error e = IsWebp(image->bytes) ? DecodeWebpPicture(image->bytes, pixels_left_, &pixels)
                                       : DecodeBasisPicture(image->bytes, pixels_left_, &pixels)) {
      return Fail("image " + Quoted(image->name) + " " + e.message);
    }
    pixels_left_ -= pixels.rgba.size() / 4;
    image->mime_type = "image/png";
    image->bytes = EncodePng(pixels.width, pixels.height, 4, pixels.rgba);
    return image->bytes.empty() ? Fail("image " + Quoted(image->name) + ": not enough memory") : Ok();
  }

  Error Copy(size_t source, Image* out) {
    const tinygltf::Image& in = model_.images[source];
    const std::string file = in.uri.starts_with("data:") ? "" : in.uri.substr(0, 200);
    out->name = NameOr(in.name.empty() ? file : in.name, "image", source);
    out->bytes = in.image;
    if (in.bufferView >= 0) {
      std::span<const uint8_t> bytes;
      if (Error e = BufferViewBytes(model_, in.bufferView, &bytes)) return e;
      out->bytes.assign(bytes.begin(), bytes.end());
    }
    const auto starts = [&](std::initializer_list<uint8_t> magic) {
      return out->bytes.size() > magic.size() && std::equal(magic.begin(), magic.end(), out->bytes.begin());
    };
    if (out->bytes.empty()) return Fail("image " + Quoted(out->name) + " is missing or empty");
    if (starts({0x89, 'P', 'N', 'G'})) {
      out->mime_type = "image/png";
    } else if (starts({0xff, 0xd8, 0xff})) {
      out->mime_type = "image/jpeg";
    } else if (IsKtx2(out->bytes) || IsWebp(out->bytes)) {
      return Unpack(out);
    } else {
      return Fail("image " + Quoted(out->name) + " is neither PNG, JPEG, WebP nor KTX2; convert it");
    }
    return Ok();
  }

  const Model& model_;
  GltfDocument* document_;
  std::vector<int> index_;
  uint64_t pixels_left_ = kFreePixels;  // of KTX2 and WebP pictures
};

Vec2 Pair(const Value& object, const char* key, Vec2 otherwise) {
  if (!object.Has(key) || object.Get(key).ArrayLen() != 2) return otherwise;
  const Value& pair = object.Get(key);
  return {static_cast<float>(pair.Get(0).GetNumberAsDouble()), static_cast<float>(pair.Get(1).GetNumberAsDouble())};
}

UvSource ReadUvSource(int set, const tinygltf::ExtensionMap& extensions) {
  UvSource out;
  out.set = set;
  const auto it = extensions.find("KHR_texture_transform");
  if (it == extensions.end() || !it->second.IsObject()) return out;
  const Value& transform = it->second;
  out.offset = Pair(transform, "offset", out.offset);
  out.scale = Pair(transform, "scale", out.scale);
  if (transform.Has("rotation")) {
    out.rotation_rad = static_cast<float>(transform.Get("rotation").GetNumberAsDouble());
  }
  if (transform.Has("texCoord")) out.set = IndexOf(transform.Get("texCoord"));
  return out;
}

Vec4 Factor(const std::vector<double>& values) {
  if (values.size() != 4) return {1, 1, 1, 1};
  return {static_cast<float>(values[0]), static_cast<float>(values[1]), static_cast<float>(values[2]),
          static_cast<float>(values[3])};
}

// The diffuse part of KHR_materials_pbrSpecularGlossiness stands in for the base colour.
void ReadDiffuse(const Value& extension, Vec4* factor, int* texture) {
  if (extension.Has("diffuseFactor")) {
    const Value& diffuse = extension.Get("diffuseFactor");
    std::vector<double> values;
    for (size_t i = 0; i < diffuse.ArrayLen(); ++i) {
      values.push_back(diffuse.Get(static_cast<int>(i)).GetNumberAsDouble());
    }
    *factor = Factor(values);
  }
  if (extension.Has("diffuseTexture") && extension.Get("diffuseTexture").Has("index")) {
    *texture = IndexOf(extension.Get("diffuseTexture").Get("index"));
  }
}

bool SameUvs(const UvSource& a, const UvSource& b) {
  return a.set == b.set && a.rotation_rad == b.rotation_rad && Length(a.offset - b.offset) == 0 &&
         Length(a.scale - b.scale) == 0;
}

Error ReadMaterial(const tinygltf::Material& in, ImageTable* images, Material* out, UvSource* uv_source,
                   std::vector<std::string>* warnings) {
  const auto& pbr = in.pbrMetallicRoughness;
  out->base_color = Factor(pbr.baseColorFactor);
  // Exporters round: 1.0000006 is 1.
  out->metallic = static_cast<float>(std::clamp(pbr.metallicFactor, 0.0, 1.0));
  out->roughness = static_cast<float>(std::clamp(pbr.roughnessFactor, 0.0, 1.0));
  const bool drawn_flat =
      in.extensions.count("KHR_materials_unlit") > 0 || in.extensions.count("VRMC_materials_mtoon") > 0;
  if (drawn_flat) out->metallic = 0, out->roughness = 1;
  out->double_sided = in.doubleSided;
  out->alpha_cutoff = static_cast<float>(in.alphaCutoff);
  if (in.alphaMode == "MASK") out->alpha = Material::Alpha::kMask;
  if (in.alphaMode == "BLEND") out->alpha = Material::Alpha::kBlend;
  int base_texture = pbr.baseColorTexture.index;
  const auto glossiness = in.extensions.find("KHR_materials_pbrSpecularGlossiness");
  if (glossiness != in.extensions.end()) {
    ReadDiffuse(glossiness->second, &out->base_color, &base_texture);
    out->metallic = 0;
  }
  if (Error e = images->Use(base_texture, &out->base_color_image)) return e;
  if (Error e = images->Use(in.normalTexture.index, &out->normal_image)) return e;
  const UvSource normal_uvs = ReadUvSource(in.normalTexture.texCoord, in.normalTexture.extensions);
  *uv_source = out->base_color_image >= 0 ? ReadUvSource(pbr.baseColorTexture.texCoord, pbr.baseColorTexture.extensions)
                                          : normal_uvs;
  if (out->normal_image >= 0 && !SameUvs(*uv_source, normal_uvs)) {
    out->normal_image = -1;
    warnings->push_back("material " + Quoted(out->name) +
                        ": its normal map is left out, as it lies on other uvs than its colour");
  }
  return Ok();
}

Error ReadMaterials(const Model& model, GltfDocument* document, std::vector<UvSource>* uv_sources,
                    std::vector<std::string>* warnings) {
  ImageTable images(model, document);
  document->materials.resize(model.materials.size());
  uv_sources->resize(model.materials.size());
  for (size_t i = 0; i < model.materials.size(); ++i) {
    Material& material = document->materials[i];
    material.name = NameOr(model.materials[i].name, "material", i);
    if (Error e = ReadMaterial(model.materials[i], &images, &material, &(*uv_sources)[i], warnings)) {
      return Fail("material " + Quoted(material.name) + ": " + e.message);
    }
  }
  return Ok();
}

bool WantedAttribute(const std::string& name) {
  return name == "POSITION" || name == "NORMAL" || name == "COLOR_0" || name.starts_with("TEXCOORD_") ||
         name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_");
}

Error ReadDracoPrimitive(const Model& model, const tinygltf::Primitive& in, const Value& extension, RawPrimitive* raw) {
  if (!extension.Has("bufferView") || !extension.Has("attributes")) {
    return Fail("KHR_draco_mesh_compression lacks bufferView or attributes");
  }
  std::span<const uint8_t> bytes;
  if (Error e = BufferViewBytes(model, IndexOf(extension.Get("bufferView")), &bytes)) {
    return e;
  }
  std::vector<std::string> names;
  std::vector<DracoAttribute> attributes;
  for (const std::string& name : extension.Get("attributes").Keys()) {
    if (!WantedAttribute(name)) continue;
    names.push_back(name);
    attributes.push_back({IndexOf(extension.Get("attributes").Get(name)), 0, false, {}});
  }
  if (Error e = DecodeDraco(bytes, attributes, &raw->indices)) return e;
  raw->indexed = true;
  for (size_t i = 0; i < names.size(); ++i) {
    const auto accessor = in.attributes.find(names[i]);
    if (accessor == in.attributes.end() || !InRange(model.accessors, accessor->second)) {
      return Fail(names[i] + " has no accessor");
    }
    const tinygltf::Accessor& a = At(model.accessors, accessor->second);
    if (a.normalized && !attributes[i].normalized) {
      const int bits = 8 * tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(a.componentType));
      const bool is_signed =
          a.componentType == TINYGLTF_COMPONENT_TYPE_BYTE || a.componentType == TINYGLTF_COMPONENT_TYPE_SHORT;
      const double largest = static_cast<double>((1ull << (bits - (is_signed ? 1 : 0))) - 1);
      for (float& v : attributes[i].values) v = static_cast<float>(v / largest);
    }
    raw->attributes[names[i]] = std::move(attributes[i].values);
  }
  return Ok();
}

Error ReadPlainPrimitive(const Model& model, const tinygltf::Primitive& in, RawPrimitive* raw) {
  for (const auto& [name, accessor] : in.attributes) {
    if (!WantedAttribute(name)) continue;
    if (Error e = ReadFloats(model, accessor, 0, &raw->attributes[name])) {
      return Fail(name + ": " + e.message);
    }
  }
  raw->indexed = in.indices >= 0;
  return raw->indexed ? ReadIndices(model, in.indices, &raw->indices) : Ok();
}

// Of the first node that shows the mesh and has some, else the mesh's own.
std::vector<double> MorphWeights(const Model& model, size_t mesh) {
  for (const tinygltf::Node& node : model.nodes) {
    if (node.mesh == static_cast<int>(mesh) && !node.weights.empty()) return node.weights;
  }
  return model.meshes[mesh].weights;
}

// One target's offsets of an attribute that the primitive has; empty: it has none.
Error ReadTarget(const Model& model, const tinygltf::Primitive& in, size_t t, const char* name, const RawPrimitive& raw,
                 std::vector<float>* offsets) {
  const auto target = in.targets[t].find(name);
  const auto own = raw.attributes.find(name);
  if (target == in.targets[t].end() || own == raw.attributes.end()) return Ok();
  if (Error e = ReadFloats(model, target->second, 3, offsets))
    return Fail("morph target " + std::to_string(t) + ": " + e.message);
  if (offsets->size() != own->second.size())
    return Fail("morph target " + std::to_string(t) + " has not one " + name + " a vertex");
  if (!std::all_of(offsets->begin(), offsets->end(), [](float v) { return std::isfinite(v); }))
    return Fail("morph target " + std::to_string(t) + " moves a vertex to where no number is; repair the mesh");
  return Ok();
}

// The shape that the file's own weights make: faces are modelled in them.
Error AddMorphs(const Model& model, const tinygltf::Primitive& in, const std::vector<double>& weights,
                RawPrimitive* raw) {
  for (size_t t = 0; t < std::min(weights.size(), in.targets.size()); ++t) {
    if (weights[t] == 0 || !std::isfinite(weights[t])) continue;
    for (const char* name : {"POSITION", "NORMAL"}) {
      std::vector<float> offsets;
      if (Error e = ReadTarget(model, in, t, name, *raw, &offsets)) return e;
      for (size_t i = 0; i < offsets.size(); ++i)
        raw->attributes[name][i] += static_cast<float>(weights[t]) * offsets[i];
    }
  }
  return Ok();
}

Error AddFace(const Model& model, const tinygltf::Primitive& in, const FaceTargets& face, RawPrimitive* raw) {
  for (size_t move = 0; move < kFaceMoves; ++move) {
    std::vector<float> sum;
    for (const WeightedTarget& each : face[move]) {
      std::vector<float> offsets;
      if (each.target >= in.targets.size()) continue;
      if (Error e = ReadTarget(model, in, each.target, "POSITION", *raw, &offsets)) return e;
      sum.resize(offsets.size());
      for (size_t i = 0; i < sum.size(); ++i) sum[i] += each.weight * offsets[i];
    }
    if (!sum.empty()) raw->attributes["FACE_" + std::to_string(move)] = std::move(sum);
  }
  return Ok();
}

// What a mesh's morph targets are for.
struct MorphUse {
  std::vector<double> weights;  // at rest
  FaceTargets face;
};

Error ReadPrimitive(const Model& model, const tinygltf::Primitive& in, const std::vector<UvSource>& uv_sources,
                    const MorphUse& morphs, DocumentPrimitive* out) {
  RawPrimitive raw;
  if (in.mode == TINYGLTF_MODE_TRIANGLE_STRIP) raw.mode = TriangleMode::kStrip;
  if (in.mode == TINYGLTF_MODE_TRIANGLE_FAN) raw.mode = TriangleMode::kFan;
  const auto draco = in.extensions.find("KHR_draco_mesh_compression");
  const bool compressed = draco != in.extensions.end();
  if (compressed) raw.mode = TriangleMode::kList;  // whatever the mode was, Draco holds triangles
  if (Error e = compressed ? ReadDracoPrimitive(model, in, draco->second, &raw) : ReadPlainPrimitive(model, in, &raw)) {
    return e;
  }
  if (Error e = AddMorphs(model, in, morphs.weights, &raw)) return e;
  if (Error e = AddFace(model, in, morphs.face, &raw)) return e;
  UvSource uv_source;
  if (in.material >= Count(uv_sources)) {
    return Fail("material " + std::to_string(in.material) + " does not exist");
  }
  out->mesh.material = in.material;
  if (in.material >= 0) uv_source = At(uv_sources, in.material);
  return MakePrimitive(std::move(raw), uv_source, out);
}

Error ReadMesh(const Model& model, size_t index, const std::vector<UvSource>& uv_sources, DocumentMesh* out) {
  const MorphUse morphs{MorphWeights(model, index), FindFaceTargets(model, index)};
  for (const tinygltf::Primitive& in : model.meshes[index].primitives) {
    out->morphs = out->morphs || !in.targets.empty();
    const bool triangles =
        in.mode == -1 || (in.mode >= TINYGLTF_MODE_TRIANGLES && in.mode <= TINYGLTF_MODE_TRIANGLE_FAN);
    if (!triangles) continue;
    DocumentPrimitive primitive;
    if (Error e = ReadPrimitive(model, in, uv_sources, morphs, &primitive)) return e;
    primitive.mesh.name = out->name;
    if (!primitive.mesh.indices.empty()) out->primitives.push_back(std::move(primitive));
  }
  return Ok();
}

// Only meshes that the scene shows.
Error ReadMeshes(const Model& model, const std::vector<UvSource>& uv_sources, GltfDocument* document) {
  document->meshes.resize(model.meshes.size());
  std::vector<bool> done(model.meshes.size());
  for (const int i : document->order) {
    const DocumentNode& node = At(document->nodes, i);
    if (!node.in_scene || node.mesh < 0 || At(done, node.mesh)) continue;
    const size_t m = static_cast<size_t>(node.mesh);
    done[m] = true;
    document->meshes[m].name = NameOr(model.meshes[m].name, "mesh", m);
    if (Error e = ReadMesh(model, m, uv_sources, &document->meshes[m])) {
      return Fail("node " + Quoted(node.name) + ", mesh " + Quoted(document->meshes[m].name) + ": " + e.message);
    }
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

Error LoadGltf(const std::filesystem::path& path, GltfDocument* document, std::vector<std::string>* warnings) {
  *document = {};
  document->path = path.string();
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
