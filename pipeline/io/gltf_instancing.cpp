#include "pipeline/io/gltf_instancing.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>

#include "pipeline/io/gltf_accessor.h"
#include "pipeline/io/gltf_number.h"
#include "runtime/base/array.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

using tinygltf::Value;

constexpr const char* kExtension = "EXT_mesh_gpu_instancing";

// Null where the node has no instances.
const Value* AttributesOf(const tinygltf::Node& node) {
  const auto found = node.extensions.find(kExtension);
  if (found == node.extensions.end() || !found->second.Has("attributes")) return nullptr;
  const Value& attributes = found->second.Get("attributes");
  return attributes.IsObject() ? &attributes : nullptr;
}

// What of a place differs from one instance to the next; empty where the file does not say.
struct Places {
  std::vector<float> translation, rotation, scale;
};

Error ReadPlaces(const tinygltf::Model& model, const Value& attributes, size_t count, Places* places) {
  struct Kind {
    const char* name;
    int components;
    std::vector<float>* values;
  };
  for (const Kind& kind : {Kind{"TRANSLATION", 3, &places->translation}, Kind{"ROTATION", 4, &places->rotation},
                           Kind{"SCALE", 3, &places->scale}}) {
    if (!attributes.Has(kind.name)) continue;
    if (Error e = ReadFloats(model, IndexOf(attributes.Get(kind.name)), kind.components, kind.values))
      return Fail(std::string(kind.name) + ": " + e.message);
    if (kind.values->size() != count * static_cast<size_t>(kind.components))
      return Fail(std::string(kind.name) + " is of another number of instances");
    if (!std::all_of(kind.values->begin(), kind.values->end(), [](float v) { return std::isfinite(v); }))
      return Fail(std::string(kind.name) + " is not finite");
  }
  return Ok();
}

DocumentNode InstanceOf(const DocumentNode& node, int parent, const Places& places, size_t i) {
  DocumentNode instance;
  instance.name = node.name;
  instance.parent = parent;
  instance.mesh = node.mesh;
  const auto three = [&](const std::vector<float>& v) { return Vec3{v[3 * i], v[3 * i + 1], v[3 * i + 2]}; };
  if (!places.translation.empty()) instance.translation = three(places.translation);
  if (!places.scale.empty()) instance.scale = three(places.scale);
  if (!places.rotation.empty()) {
    const float* q = places.rotation.data() + 4 * i;
    instance.rotation = Normalized(Quat{q[0], q[1], q[2], q[3]});
  }
  return instance;
}

}  // namespace

uint64_t CountInstances(const tinygltf::Model& model, const tinygltf::Node& node) {
  const Value* attributes = AttributesOf(node);
  if (attributes == nullptr) return 1;
  uint64_t count = 0;
  for (const std::string& name : attributes->Keys()) {
    const int accessor = IndexOf(attributes->Get(name));
    if (InRange(model.accessors, accessor)) count = std::max<uint64_t>(count, At(model.accessors, accessor).count);
  }
  return count;
}

Error SpreadInstances(const tinygltf::Model& model, GltfDocument* document) {
  for (size_t n = 0; n < model.nodes.size(); ++n) {
    const Value* attributes = AttributesOf(model.nodes[n]);
    if (attributes == nullptr || document->nodes[n].mesh < 0) continue;
    const auto count = static_cast<size_t>(CountInstances(model, model.nodes[n]));
    Places places;
    if (Error e = ReadPlaces(model, *attributes, count, &places))
      return Fail("node '" + OneLine(document->nodes[n].name) + "': " + kExtension + ": " + e.message);
    for (size_t i = 0; i < count; ++i)
      document->nodes.push_back(InstanceOf(document->nodes[n], static_cast<int>(n), places, i));
    document->nodes[n].mesh = -1;
  }
  return Ok();
}

}  // namespace flaneur
