#include "pipeline/io/gltf_nodes.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "pipeline/io/gltf_instancing.h"
#include "pipeline/io/gltf_names.h"
#include "pipeline/io/gltf_number.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

using tinygltf::Model;
using tinygltf::Value;

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

Error OrderNodes(const Model& model, GltfDocument* document) {
  std::vector<std::vector<int>> children_of;
  for (const tinygltf::Node& node : model.nodes) children_of.push_back(node.children);
  children_of.resize(document->nodes.size());
  for (int i = Count(model.nodes); i < Count(document->nodes); ++i)
    At(children_of, At(document->nodes, i).parent).push_back(i);
  std::vector<int> roots;
  for (int i = 0; i < Count(document->nodes); ++i) {
    if (At(document->nodes, i).parent < 0) roots.push_back(i);
  }
  document->order = DepthFirst(roots, children_of);
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

}  // namespace

bool Finite(const Mat4& matrix) {
  for (const auto& column : matrix.m) {
    for (const float v : column) {
      if (!std::isfinite(v)) return false;
    }
  }
  return true;
}

Error ReadNodes(const tinygltf::Model& model, GltfDocument* document) {
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

}  // namespace flaneur
