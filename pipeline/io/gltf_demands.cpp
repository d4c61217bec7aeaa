#include "pipeline/io/gltf_demands.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "pipeline/io/gltf_instancing.h"
#include "pipeline/io/meshopt_codec.h"
#include "pipeline/io/town_points.h"
#include "runtime/base/array.h"
#include "runtime/base/limits.h"

namespace flaneur {
namespace {

constexpr uint64_t kNumber_bytes = 4;

uint64_t Times(uint64_t a, uint64_t b) {
  constexpr uint64_t kMost = std::numeric_limits<uint64_t>::max() / 4;
  return b != 0 && a > kMost / b ? kMost : a * b;
}

class Demands {
 public:
  explicit Demands(const tinygltf::Model& model) : model_(model) {}

  void AddAccessor(int index) {
    if (!InRange(model_.accessors, index)) return;  // its reader says what is wrong
    const tinygltf::Accessor& accessor = At(model_.accessors, index);
    const int components = std::max(1, tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type)));
    Add(Times(accessor.count, kNumber_bytes * static_cast<uint64_t>(components)));
  }

  void Add(uint64_t bytes) { bytes_ = std::min(bytes_ + bytes, std::numeric_limits<uint64_t>::max() / 4); }
  uint64_t bytes() const { return bytes_; }

 private:
  const tinygltf::Model& model_;
  uint64_t bytes_ = 0;
};

void AddMeshes(const tinygltf::Model& model, Demands* demands) {
  for (const tinygltf::Mesh& mesh : model.meshes) {
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      for (const auto& [name, accessor] : primitive.attributes) demands->AddAccessor(accessor);
      demands->AddAccessor(primitive.indices);
      for (const auto& target : primitive.targets) {
        for (const auto& [name, accessor] : target) demands->AddAccessor(accessor);
      }
    }
  }
}

// Attributes of instances, and the nodes that they become.
void AddInstances(const tinygltf::Model& model, Demands* demands) {
  for (const tinygltf::Node& node : model.nodes) {
    if (const uint64_t count = CountInstances(model, node); count > 1)
      demands->Add(Times(count, sizeof(DocumentNode) + 10 * sizeof(float)));
  }
}

uint64_t CountOf(const tinygltf::Model& model, int accessor) {
  return InRange(model.accessors, accessor) ? At(model.accessors, accessor).count : 0;
}

// Each mesh as often as nodes show it.
Error CheckShown(const tinygltf::Model& model, uint64_t file_bytes) {
  std::vector<uint64_t> points;
  for (const tinygltf::Mesh& mesh : model.meshes) {
    points.push_back(0);
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      const auto position = primitive.attributes.find("POSITION");
      const uint64_t vertices = position != primitive.attributes.end() ? CountOf(model, position->second) : 0;
      points.back() += std::max(vertices, CountOf(model, primitive.indices));
    }
  }
  TownPoints left(file_bytes);
  for (const tinygltf::Node& node : model.nodes) {
    if (!InRange(model.meshes, node.mesh)) continue;
    if (Error e = left.Take(Times(CountInstances(model, node), At(points, node.mesh)))) return e;
  }
  return Ok();
}

void AddAnimations(const tinygltf::Model& model, Demands* demands) {
  for (const tinygltf::Animation& animation : model.animations) {
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
      if (!InRange(animation.samplers, channel.sampler)) continue;
      demands->AddAccessor(At(animation.samplers, channel.sampler).input);
      demands->AddAccessor(At(animation.samplers, channel.sampler).output);
    }
  }
  for (const tinygltf::Skin& skin : model.skins) demands->AddAccessor(skin.inverseBindMatrices);
}

void AddImages(const tinygltf::Model& model, Demands* demands) {
  for (const tinygltf::Image& image : model.images) {
    if (InRange(model.bufferViews, image.bufferView)) demands->Add(At(model.bufferViews, image.bufferView).byteLength);
  }
}

// Members that are no numbers are for their reader to refuse.
void AddCompressedViews(const tinygltf::Model& model, Demands* demands) {
  for (const tinygltf::BufferView& view : model.bufferViews) {
    const auto found = view.extensions.find(std::string(kMeshoptExtension));
    if (found == view.extensions.end() || !found->second.IsObject()) continue;
    const auto number = [&](const char* key) {
      const double value = found->second.Get(key).IsNumber() ? found->second.Get(key).GetNumberAsDouble() : 0;
      return value > 0 && value < 1e15 ? static_cast<uint64_t>(value) : uint64_t{0};
    };
    demands->Add(Times(number("count"), number("byteStride")));
  }
}

Error CheckDepth(const tinygltf::Model& model) {
  std::vector<int> depth(model.nodes.size(), -1);
  std::vector<int> level;
  std::vector<bool> is_child(model.nodes.size(), false);
  for (const tinygltf::Node& node : model.nodes) {
    for (const int child : node.children) {
      if (InRange(model.nodes, child)) is_child[static_cast<size_t>(child)] = true;
    }
  }
  for (size_t i = 0; i < model.nodes.size(); ++i) {
    if (!is_child[i]) level.push_back(static_cast<int>(i));
  }
  // Level by level; who is reached twice has two parents, which its reader refuses.
  for (size_t deep = 0; !level.empty(); ++deep) {
    if (deep >= kMostNodeDepth) return Fail("has more than " + std::to_string(kMostNodeDepth) + " nodes in each other");
    std::vector<int> next;
    for (const int node : level) {
      for (const int child : At(model.nodes, node).children) {
        if (!InRange(model.nodes, child) || At(depth, child) >= 0) continue;
        At(depth, child) = static_cast<int>(deep);
        next.push_back(child);
      }
    }
    level = std::move(next);
  }
  return Ok();
}

}  // namespace

Error CheckDemands(const tinygltf::Model& model, uint64_t file_bytes) {
  Demands demands(model);
  AddMeshes(model, &demands);
  AddInstances(model, &demands);
  AddAnimations(model, &demands);
  AddImages(model, &demands);
  AddCompressedViews(model, &demands);
  if (demands.bytes() > kModelMemory_bytes + Times(kModelMemoryAByte, file_bytes))
    return Fail("asks for " + std::to_string(demands.bytes() / 1048576) +
                " MiB of memory, far more than its size is worth");
  if (Error e = CheckShown(model, file_bytes)) return e;
  return CheckDepth(model);
}

}  // namespace flaneur
