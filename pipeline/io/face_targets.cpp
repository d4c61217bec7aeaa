#include "pipeline/io/face_targets.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <string>

#include "pipeline/io/gltf_number.h"

namespace flaneur {
namespace {

using tinygltf::Model;
using tinygltf::Value;

constexpr float kJaw = 0.6f;  // of a jaw that opens as wide as it can: speech does not

// Names stand in the extras of the mesh or, by older exporters, of its first primitive.
std::vector<std::string> TargetNames(const tinygltf::Mesh& mesh) {
  std::vector<std::string> names;
  const Value* const places[] = {&mesh.extras, mesh.primitives.empty() ? nullptr : &mesh.primitives[0].extras};
  for (const Value* extras : places) {
    if (!names.empty() || extras == nullptr || !extras->IsObject() || !extras->Has("targetNames")) continue;
    const Value& list = extras->Get("targetNames");
    for (size_t i = 0; list.IsArray() && i < list.ArrayLen(); ++i) {
      const Value& name = list.Get(static_cast<int>(i));
      names.push_back(name.IsString() ? name.Get<std::string>() : "");
    }
  }
  return names;
}

const Value& Member(const Value& value, const char* key) {
  static const Value kNothing;
  return value.IsObject() && value.Has(key) ? value.Get(key) : kNothing;
}

// A list of what moves, each a mesh or a node that shows it, the target's number and a weight of `whole`.
std::vector<WeightedTarget> BindsOf(const Model& model, const Value& binds, size_t mesh, double whole) {
  std::vector<WeightedTarget> found;
  for (size_t i = 0; binds.IsArray() && i < binds.ArrayLen(); ++i) {
    const Value& bind = binds.Get(static_cast<int>(i));
    const Value &by_mesh = Member(bind, "mesh"), &by_node = Member(bind, "node");
    const Value &index = Member(bind, "index"), &weight = Member(bind, "weight");
    int shown = IndexOf(by_mesh);
    const int node = IndexOf(by_node);
    if (node >= 0 && static_cast<size_t>(node) < model.nodes.size())
      shown = model.nodes[static_cast<size_t>(node)].mesh;
    if (shown != static_cast<int>(mesh) || IndexOf(index) < 0) continue;
    const double share = weight.IsNumber() ? weight.GetNumberAsDouble() / whole : 1;
    if (share > 0 && share <= 1) found.push_back({static_cast<size_t>(IndexOf(index)), static_cast<float>(share)});
  }
  return found;
}

// VRM 0.x lists groups of morphs, VRM 1.0 has an expression a name.
std::vector<WeightedTarget> OfPreset(const Model& model, size_t mesh, const char* old_name, const char* new_name) {
  if (const auto vrm = model.extensions.find("VRM"); vrm != model.extensions.end()) {
    const Value& groups = Member(Member(vrm->second, "blendShapeMaster"), "blendShapeGroups");
    for (size_t i = 0; groups.IsArray() && i < groups.ArrayLen(); ++i) {
      const Value& group = groups.Get(static_cast<int>(i));
      const Value& preset = Member(group, "presetName");
      if (preset.IsString() && preset.Get<std::string>() == old_name)
        return BindsOf(model, Member(group, "binds"), mesh, 100);
    }
  }
  if (const auto vrm = model.extensions.find("VRMC_vrm"); vrm != model.extensions.end()) {
    const Value& preset = Member(Member(Member(vrm->second, "expressions"), "preset"), new_name);
    return BindsOf(model, Member(preset, "morphTargetBinds"), mesh, 1);
  }
  return {};
}

std::vector<WeightedTarget> OfNames(const std::vector<std::string>& names, FaceMove move) {
  int best = 1 << 10;
  for (const std::string& name : names) {
    if (const FaceName read = ReadFaceName(name); read.move == move) best = std::min(best, read.rank);
  }
  std::vector<WeightedTarget> found;
  std::array<bool, 3> has{};  // by side
  for (size_t i = 0; i < names.size(); ++i) {
    const FaceName read = ReadFaceName(names[i]);
    bool& known = has[static_cast<size_t>(read.side)];
    if (read.move != move || read.rank != best || known) continue;
    known = true;
    found.push_back({i, move == FaceMove::kOpenMouth && best < 2 ? kJaw : 1});
  }
  return found;
}

}  // namespace

FaceTargets FindFaceTargets(const Model& model, size_t mesh) {
  FaceTargets found;
  auto& blink = found[static_cast<size_t>(FaceMove::kBlink)];
  auto& mouth = found[static_cast<size_t>(FaceMove::kOpenMouth)];
  blink = OfPreset(model, mesh, "blink", "blink");
  if (blink.empty()) {
    blink = OfPreset(model, mesh, "blink_l", "blinkLeft");
    const std::vector<WeightedTarget> right = OfPreset(model, mesh, "blink_r", "blinkRight");
    blink.insert(blink.end(), right.begin(), right.end());
  }
  mouth = OfPreset(model, mesh, "a", "aa");
  const std::vector<std::string> names = TargetNames(model.meshes[mesh]);
  if (blink.empty()) blink = OfNames(names, FaceMove::kBlink);
  if (mouth.empty()) mouth = OfNames(names, FaceMove::kOpenMouth);
  return found;
}

}  // namespace flaneur
