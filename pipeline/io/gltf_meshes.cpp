#include "pipeline/io/gltf_meshes.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "pipeline/io/draco_codec.h"
#include "pipeline/io/face_targets.h"
#include "pipeline/io/gltf_accessor.h"
#include "pipeline/io/gltf_names.h"
#include "pipeline/io/gltf_number.h"
#include "pipeline/io/gltf_primitive.h"
#include "runtime/base/array.h"
#include "runtime/base/limits.h"

namespace flaneur {
namespace {

using tinygltf::Model;
using tinygltf::Value;

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

}  // namespace

Error ReadMeshes(const tinygltf::Model& model, const std::vector<UvSource>& uv_sources, GltfDocument* document) {
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

}  // namespace flaneur
