#include "runtime/pack/read_clip.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "runtime/base/array.h"
#include "runtime/base/limits.h"
#include "runtime/pack/allowance.h"

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
  const Json& json = Member(skin, "joints");
  if (json.empty() || json.size() > kMostJoints) throw PackRefused("has too many joints, or none");
  std::vector<size_t> joints;
  for (const Json& joint : json) {
    if (joint.get<size_t>() >= nodes) throw PackRefused("has a skin whose joint is no node");
    joints.push_back(joint.get<size_t>());
  }
  return joints;
}

// Of the file's nodes those that a skin's joints hang on, parents first.
void FindNodes(const NodeTree& tree, Skin* skin) {
  std::vector<int> here(tree.parent.size(), -1);
  for (const size_t joint : skin->joints) {
    for (int n = static_cast<int>(joint); n >= 0 && At(here, n) < 0; n = At(tree.parent, n)) {
      At(here, n) = 0;
      skin->nodes.push_back(n);
    }
  }
  std::stable_sort(skin->nodes.begin(), skin->nodes.end(),
                   [&](int a, int b) { return At(tree.depth, a) < At(tree.depth, b); });
  for (size_t k = 0; k < skin->nodes.size(); ++k) At(here, skin->nodes[k]) = static_cast<int>(k);
  for (const int n : skin->nodes) skin->parent.push_back(At(tree.parent, n) < 0 ? -1 : At(here, At(tree.parent, n)));
  for (const size_t joint : skin->joints) skin->joint_node.push_back(static_cast<size_t>(here[joint]));
}

// Where each node of the skin is.
void PoseAll(const Skin& skin, const std::vector<NodePose>& pose, std::vector<Mat4>* global) {
  global->resize(pose.size());
  for (size_t k = 0; k < pose.size(); ++k) {
    const Mat4 local = FromTranslationRotationScale(pose[k].translation, pose[k].rotation, pose[k].scale);
    (*global)[k] = skin.parent[k] < 0 ? local : At(*global, skin.parent[k]) * local;
  }
}

bool IsWithinReach(Vec3 p) {
  const auto within = [](float m) { return std::abs(static_cast<double>(m)) <= kMostCoordinate_m; };
  return within(p.x) && within(p.y) && within(p.z);
}

void CheckMatrices(const std::vector<Mat4>& matrices) {
  for (const Mat4& matrix : matrices) {
    for (const auto& column : matrix.m) {
      if (!IsWithinReach({column[0], column[1], column[2]}))
        throw PackRefused("has a clip that moves joints out of range");
    }
  }
}

// What a clip of so many frames takes.
void TakeFrames(const GltfFile& file, const Skin& skin, size_t channels, int frames) {
  if (file.allowance == nullptr) return;
  constexpr uint64_t kNodeWork = 10, kChannelWork = 5;
  const auto count = static_cast<uint64_t>(frames);
  file.allowance->TakeMemory(Product(count, skin.joints.size() * sizeof(Mat4)), "a clip");
  file.allowance->TakeWork(
      Product(count, kNodeWork * (skin.nodes.size() + skin.joints.size()) + kChannelWork * channels), "a clip");
}

}  // namespace

Skin ReadSkin(const GltfFile& file, int index) {
  const Json& nodes = Member(file.json, "nodes");
  const Json& json = Element(file.json, "skins", index);
  if (file.allowance != nullptr) file.allowance->TakeWork(nodes.size(), "a skin");
  Skin skin;
  skin.joints = JointNodes(json, nodes.size());
  skin.inverse_binds = InverseBinds(file, json, skin.joints.size());
  FindNodes(file.tree, &skin);
  return skin;
}

std::vector<PackJoint> ReadSkeleton(const GltfFile& file, const Skin& skin) {
  const Json& nodes = Member(file.json, "nodes");
  std::vector<int> joint_of(skin.nodes.size(), -1);
  for (size_t j = 0; j < skin.joints.size(); ++j) joint_of[skin.joint_node[j]] = static_cast<int>(j);
  std::vector<PackJoint> skeleton;
  for (size_t j = 0; j < skin.joints.size(); ++j) {
    PackJoint joint;
    const Json& node = nodes[skin.joints[j]];
    if (node.contains("name") && node["name"].is_string()) joint.name = node["name"].get<std::string>();
    int above = skin.parent[skin.joint_node[j]];
    while (above >= 0 && At(joint_of, above) < 0) above = At(skin.parent, above);
    if (above >= 0) joint.parent = At(joint_of, above);
    if (file.allowance != nullptr) file.allowance->TakeMemory(joint.name.size() + sizeof joint, "a skeleton");
    joint.rest_m = TransformPoint(Inverse(skin.inverse_binds[j]), {});
    if (!IsWithinReach(joint.rest_m)) throw PackRefused("has a skin whose joint rests out of range");
    skeleton.push_back(std::move(joint));
  }
  return skeleton;
}

PackClip ReadClip(const GltfFile& file, const Skin& skin, int animation_index) {
  const Json& nodes = Member(file.json, "nodes");
  std::vector<Channel> channels;
  PackClip clip;
  if (animation_index >= 0) {
    const Json& animation = Element(file.json, "animations", animation_index);
    for (const Json& json : Member(animation, "channels")) channels.push_back(ReadChannel(file, animation, json));
    for (const Channel& c : channels) clip.duration_s = std::max(clip.duration_s, c.times_s.back());
  }
  if (!(clip.duration_s >= 0 && clip.duration_s < kMostClip_s)) throw PackRefused("has an animation of odd length");
  clip.frames = std::max(1, static_cast<int>(std::lround(clip.duration_s * kClipRateHz)));
  TakeFrames(file, skin, channels.size(), clip.frames);

  std::map<int, size_t> here;  // by node of the file
  std::vector<NodePose> rest;
  for (const int n : skin.nodes) {
    here.emplace(n, rest.size());
    rest.push_back(RestPose(At(nodes, n)));
  }
  std::erase_if(channels, [&](const Channel& c) { return !here.contains(c.node); });
  for (Channel& c : channels) c.node = static_cast<int>(here.at(c.node));
  std::vector<NodePose> pose;
  std::vector<Mat4> global;
  clip.matrices.reserve(static_cast<size_t>(clip.frames) * skin.joints.size());
  for (int frame = 0; frame < clip.frames; ++frame) {
    pose = rest;
    const float time_s = clip.duration_s * static_cast<float>(frame) / static_cast<float>(clip.frames);
    for (const Channel& c : channels) Apply(c, time_s, &At(pose, c.node));
    PoseAll(skin, pose, &global);
    for (size_t j = 0; j < skin.joints.size(); ++j)
      clip.matrices.push_back(global[skin.joint_node[j]] * skin.inverse_binds[j]);
  }
  CheckMatrices(clip.matrices);
  return clip;
}

}  // namespace flaneur
