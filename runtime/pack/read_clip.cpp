#include "runtime/pack/read_clip.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/array.h"

namespace flaneur {
namespace {

struct NodePose {
  Vec3 translation;
  Quat rotation;
  Vec3 scale{1, 1, 1};
};

struct Channel {
  int node = 0;
  enum class Path { kTranslation, kRotation, kScale } path = Path::kTranslation;
  bool step = false;
  std::vector<float> times_s;
  Values values;
};

Vec3 ReadVec3(const Json& json) { return {json.at(0), json.at(1), json.at(2)}; }
Quat ReadQuat(const Json& json) { return {json.at(0), json.at(1), json.at(2), json.at(3)}; }

NodePose RestPose(const Json& node) {
  NodePose pose;
  if (node.contains("translation")) pose.translation = ReadVec3(node["translation"]);
  if (node.contains("rotation")) pose.rotation = ReadQuat(node["rotation"]);
  if (node.contains("scale")) pose.scale = ReadVec3(node["scale"]);
  return pose;
}

// For each node its parent, -1 for roots; a node with two parents or a loop is refused.
std::vector<int> Parents(const Json& nodes) {
  std::vector<int> parents(nodes.size(), -1);
  for (size_t i = 0; i < nodes.size(); ++i) {
    for (const Json& child : nodes[i].value("children", Json::array())) {
      const auto c = child.get<size_t>();
      if (c >= nodes.size() || parents[c] >= 0) throw PackRefused("has a broken node tree");
      parents[c] = static_cast<int>(i);
    }
  }
  for (size_t i = 0; i < nodes.size(); ++i) {
    size_t depth = 0;
    for (int n = static_cast<int>(i); n >= 0; n = At(parents, n)) {
      if (++depth > nodes.size()) throw PackRefused("has a loop in its node tree");
    }
  }
  return parents;
}

Channel ReadChannel(const GltfFile& file, const Json& animation, const Json& json) {
  Channel channel;
  const Json& target = Member(json, "target");
  channel.node = Index(target, "node", file.json["nodes"].size());
  const std::string path = Member(target, "path").get<std::string>();
  if (path == "translation") channel.path = Channel::Path::kTranslation;
  else if (path == "rotation") channel.path = Channel::Path::kRotation;
  else if (path == "scale") channel.path = Channel::Path::kScale;
  else throw PackRefused("has an animation of unknown path '" + path + "'");
  const Json& sampler = Element(animation, "samplers", Member(json, "sampler").get<int>());
  const std::string interpolation = sampler.value("interpolation", "LINEAR");
  if (interpolation == "CUBICSPLINE") throw PackRefused("has a cubic animation; bake the pack again");
  channel.step = interpolation == "STEP";
  channel.times_s = ReadAccessor(file, Member(sampler, "input").get<int>()).numbers;
  channel.values = ReadAccessor(file, Member(sampler, "output").get<int>());
  const int components = channel.path == Channel::Path::kRotation ? 4 : 3;
  if (channel.times_s.empty() || channel.values.components != components ||
      channel.values.count() != channel.times_s.size()) {
    throw PackRefused("has an animation whose keys and values do not match");
  }
  return channel;
}

void Apply(const Channel& channel, float time_s, NodePose* pose) {
  const auto& times = channel.times_s;
  const auto after = std::upper_bound(times.begin(), times.end(), time_s) - times.begin();
  const size_t b = std::min<size_t>(static_cast<size_t>(after), times.size() - 1);
  const size_t a = after > 0 ? static_cast<size_t>(after) - 1 : 0;
  const float span = times[b] - times[a];
  const float t = channel.step || !(span > 0) ? 0 : std::clamp((time_s - times[a]) / span, 0.0f, 1.0f);
  const size_t n = static_cast<size_t>(channel.values.components);
  const float* va = &channel.values.numbers[a * n];
  const float* vb = &channel.values.numbers[b * n];
  if (channel.path == Channel::Path::kRotation) {
    pose->rotation = Slerp({va[0], va[1], va[2], va[3]}, {vb[0], vb[1], vb[2], vb[3]}, t);
    return;
  }
  const Vec3 value{va[0] + t * (vb[0] - va[0]), va[1] + t * (vb[1] - va[1]), va[2] + t * (vb[2] - va[2])};
  (channel.path == Channel::Path::kTranslation ? pose->translation : pose->scale) = value;
}

std::vector<Mat4> InverseBinds(const GltfFile& file, const Json& skin, size_t joints) {
  std::vector<Mat4> out(joints);
  if (!skin.contains("inverseBindMatrices")) return out;
  const Values values = ReadAccessor(file, skin["inverseBindMatrices"].get<int>());
  if (values.components != 16 || values.count() != joints) throw PackRefused("has a skin with the wrong matrices");
  for (size_t j = 0; j < joints; ++j) {
    for (size_t k = 0; k < 16; ++k) out[j].m[k / 4][k % 4] = values.numbers[16 * j + k];
  }
  return out;
}

std::vector<size_t> JointNodes(const Json& skin, size_t nodes) {
  std::vector<size_t> joints;
  for (const Json& joint : Member(skin, "joints")) {
    if (joint.get<size_t>() >= nodes) throw PackRefused("has a skin whose joint is no node");
    joints.push_back(joint.get<size_t>());
  }
  return joints;
}

}  // namespace

std::vector<PackJoint> ReadSkeleton(const GltfFile& file, int skin_index) {
  const Json& nodes = Member(file.json, "nodes");
  const Json& skin = Element(file.json, "skins", skin_index);
  const std::vector<int> parents = Parents(nodes);
  const std::vector<size_t> joints = JointNodes(skin, nodes.size());
  const std::vector<Mat4> inverse_binds = InverseBinds(file, skin, joints.size());
  std::vector<int> joint_of(nodes.size(), -1);
  for (size_t j = 0; j < joints.size(); ++j) joint_of[joints[j]] = static_cast<int>(j);
  std::vector<PackJoint> skeleton;
  for (size_t j = 0; j < joints.size(); ++j) {
    PackJoint joint;
    const Json& node = nodes[joints[j]];
    if (node.contains("name") && node["name"].is_string()) joint.name = node["name"].get<std::string>();
    int above = parents[joints[j]];
    while (above >= 0 && At(joint_of, above) < 0) above = At(parents, above);
    if (above >= 0) joint.parent = At(joint_of, above);
    joint.rest_m = TransformPoint(Inverse(inverse_binds[j]), {});
    skeleton.push_back(std::move(joint));
  }
  return skeleton;
}

PackClip ReadClip(const GltfFile& file, int skin_index, int animation_index) {
  const Json& nodes = Member(file.json, "nodes");
  const Json& skin = Element(file.json, "skins", skin_index);
  const std::vector<int> parents = Parents(nodes);
  const std::vector<size_t> joints = JointNodes(skin, nodes.size());
  const std::vector<Mat4> inverse_binds = InverseBinds(file, skin, joints.size());

  std::vector<Channel> channels;
  PackClip clip;
  if (animation_index >= 0) {
    const Json& animation = Element(file.json, "animations", animation_index);
    for (const Json& json : Member(animation, "channels")) channels.push_back(ReadChannel(file, animation, json));
    for (const Channel& c : channels) clip.duration_s = std::max(clip.duration_s, c.times_s.back());
  }
  if (!(clip.duration_s >= 0 && clip.duration_s < 600)) throw PackRefused("has an animation of odd length");
  clip.frames = std::max(1, static_cast<int>(std::lround(clip.duration_s * kClipRateHz)));

  std::vector<NodePose> rest(nodes.size());
  for (size_t i = 0; i < nodes.size(); ++i) rest[i] = RestPose(nodes[i]);
  for (int frame = 0; frame < clip.frames; ++frame) {
    std::vector<NodePose> pose = rest;
    const float time_s = clip.duration_s * static_cast<float>(frame) / static_cast<float>(clip.frames);
    for (const Channel& c : channels) Apply(c, time_s, &At(pose, c.node));
    for (size_t j = 0; j < joints.size(); ++j) {
      Mat4 global;
      for (int n = static_cast<int>(joints[j]); n >= 0; n = At(parents, n)) {
        const NodePose& p = At(pose, n);
        global = FromTranslationRotationScale(p.translation, p.rotation, p.scale) * global;
      }
      clip.matrices.push_back(global * inverse_binds[j]);
    }
  }
  return clip;
}

}  // namespace flaneur
