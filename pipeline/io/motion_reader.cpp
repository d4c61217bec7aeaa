#include "pipeline/io/motion_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "pipeline/io/blender_import.h"
#include "pipeline/io/bvh_reader.h"
#include "pipeline/io/gltf_pose.h"
#include "runtime/base/array.h"
#include "runtime/base/file.h"
#include "runtime/base/limits.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace fs = std::filesystem;
namespace {

constexpr float kKeysPerSecond = 30;

float Determinant(const Mat4& m) {
  const Vec3 x{m.m[0][0], m.m[0][1], m.m[0][2]};
  const Vec3 y{m.m[1][0], m.m[1][1], m.m[1][2]};
  const Vec3 z{m.m[2][0], m.m[2][1], m.m[2][2]};
  return Dot(Cross(x, y), z);
}

// All nodes that may be bones: what a clip moves, joints of skins and what they hang on; without skins all nodes that
// show nothing themselves. Objects that hold a mesh are often called after the limb that they show.
std::vector<bool> Bones(const GltfDocument& document) {
  const bool skinned = !document.skins.empty();
  std::vector<bool> bones(document.nodes.size(), false);
  for (const DocumentClip& clip : document.clips) {
    for (const DocumentChannel& channel : clip.channels) At(bones, channel.node) = true;
  }
  for (const DocumentSkin& skin : document.skins) {
    for (const int joint : skin.joints) At(bones, joint) = true;
  }
  for (size_t i = 0; i < bones.size(); ++i) {
    bones[i] = bones[i] || (!skinned && document.nodes[i].mesh < 0);
    for (int a = document.nodes[i].parent; bones[i] && a >= 0; a = At(document.nodes, a).parent) At(bones, a) = true;
  }
  return bones;
}

// The joint that a vertex hangs on most; -1: none.
int HeaviestJoint(const Influences& influences, size_t vertex) {
  const size_t width = static_cast<size_t>(influences.per_vertex), first = vertex * width;
  size_t heaviest = first;
  for (size_t i = first; i < first + width; ++i)
    if (influences.weights[i] > influences.weights[heaviest]) heaviest = i;
  return width > 0 && influences.weights[heaviest] > 0 ? influences.joints[heaviest] : -1;
}

// The vertices of what the file shows, as the skeleton rests, each on one joint: where arms of one bone end.
void TakeFigure(const std::vector<int>& joint_of, const std::vector<Mat4>& rest, MotionFile* motion) {
  const GltfDocument& document = motion->document;
  if (motion->joint_nodes.size() > UINT16_MAX) return;
  for (const int n : document.order) {
    const DocumentNode& node = At(document.nodes, n);
    if (!node.in_scene || node.mesh < 0) continue;
    int bone = n;  // that a thing without a skin hangs on
    while (bone >= 0 && At(joint_of, bone) < 0) bone = At(document.nodes, bone).parent;
    const DocumentSkin* const skin = node.skin >= 0 ? &At(document.skins, node.skin) : nullptr;
    std::vector<Mat4> as_bound;  // by the skin's joint
    for (size_t k = 0; skin != nullptr && k < skin->joints.size(); ++k)
      as_bound.push_back(At(rest, skin->joints[k]) * skin->inverse_binds[k]);
    for (const DocumentPrimitive& primitive : At(document.meshes, node.mesh).primitives) {
      Mesh figure;
      for (size_t v = 0; v < primitive.mesh.positions.size(); ++v) {
        const int k = skin != nullptr ? HeaviestJoint(primitive.influences, v) : -1;
        if (skin != nullptr && !InRange(skin->joints, k)) continue;
        const int on = skin != nullptr ? At(skin->joints, k) : bone;
        if (on < 0 || At(joint_of, on) < 0) continue;
        const Mat4& place = skin != nullptr ? At(as_bound, k) : At(rest, n);
        figure.positions.push_back(TransformPoint(place, primitive.mesh.positions[v]));
        figure.joints.push_back({static_cast<uint16_t>(At(joint_of, on)), 0, 0, 0});
        figure.weights.push_back({1, 0, 0, 0});
      }
      motion->skeleton.meshes.push_back(std::move(figure));
    }
  }
}

void TakeSkeleton(MotionFile* motion) {
  const GltfDocument& document = motion->document;
  const std::vector<bool> bones = Bones(document);
  const std::vector<Mat4> rest = WorldMatrices(document);
  std::vector<int> joint_of(document.nodes.size(), -1);
  for (const int node : document.order) {
    const DocumentNode& own = At(document.nodes, node);
    if (!own.in_scene || !At(bones, node)) continue;
    Joint joint;
    joint.name = own.name;
    for (int a = own.parent; a >= 0 && joint.parent < 0; a = At(document.nodes, a).parent)
      joint.parent = At(joint_of, a);
    At(joint_of, node) = Count(motion->joint_nodes);
    const Mat4 unscale = Unscaled(At(rest, node));
    const Mat4 world = At(rest, node) * unscale;
    joint.inverse_bind = Inverse(world);
    joint.rest = Decomposed(joint.parent < 0 ? world : At(motion->skeleton.joints, joint.parent).inverse_bind * world);
    motion->joint_nodes.push_back(node);
    motion->unscale.push_back(unscale);
    motion->skeleton.joints.push_back(std::move(joint));
  }
  for (const DocumentBone& bone : document.bones) {
    const int joint = At(joint_of, bone.node);
    if (joint >= 0) motion->told.push_back({joint, bone.part, bone.side});
  }
  TakeFigure(joint_of, rest, motion);
}

Error Open(const fs::path& path, MotionFile* motion) {
  if (HasExtension(path, ".bvh")) {
    if (Error e = ReadBvh(path, kLongestClip_s, &motion->skeleton)) return e;
    motion->clip_names = {motion->skeleton.clips[0].name};
    return Ok();
  }
  TemporaryFolder folder;
  fs::path gltf = path;
  if (NeedsBlender(path)) {
    if (Error e = ConvertToGltf(path, &folder, &gltf)) return e;
  }
  std::vector<std::string> notes;  // of pictures and the like, which don't matter here
  if (Error e = LoadGltf(gltf, &motion->document, &notes, path)) return e;
  for (const DocumentClip& clip : motion->document.clips) motion->clip_names.push_back(clip.name);
  TakeSkeleton(motion);
  return Ok();
}

}  // namespace

Mat4 Unscaled(const Mat4& rest) {
  const float volume = Determinant(rest);
  const float scale = volume != 0 ? 1 / std::cbrt(std::abs(volume)) : 1.0f;
  return FromTranslationRotationScale({}, {}, {volume < 0 ? -scale : scale, scale, scale});
}

Error SampleClip(const GltfDocument& document, const DocumentClip& source, const std::vector<Joint>& joints,
                 const std::vector<int>& joint_nodes, const std::vector<Mat4>& unscale, Clip* out) {
  const ClipSpan span = SpanOf(source);
  Clip clip;
  clip.name = source.name;
  clip.duration_s = std::min(span.end_s - span.start_s, kLongestClip_s);
  clip.keys = std::max(2, 1 + static_cast<int>(std::lround(clip.duration_s * kKeysPerSecond)));
  if (static_cast<size_t>(clip.keys) * (document.nodes.size() + source.channels.size()) > kMostPoses)
    return Fail("clip '" + OneLine(source.name) +
                "' is too long for so many nodes and channels; cut it, or simplify the file");
  const float length_s = clip.duration_s;
  if (!(clip.duration_s > 0)) clip.duration_s = 1;  // a pose, held
  const size_t count = joints.size();
  for (int k = 0; k < clip.keys; ++k) {
    const float share = static_cast<float>(k) / static_cast<float>(clip.keys - 1);
    const std::vector<Mat4> world = PoseAt(document, source, span.start_s + share * length_s);
    std::vector<Mat4> own(count);
    for (size_t j = 0; j < count; ++j) {
      own[j] = At(world, joint_nodes[j]) * unscale[j];
      const int parent = joints[j].parent;
      Transform local = Decomposed(parent < 0 ? own[j] : Inverse(At(own, parent)) * own[j]);
      if (k > 0) {
        const Quat b = clip.transforms[clip.transforms.size() - count].rotation;
        Quat& q = local.rotation;
        if (q.x * b.x + q.y * b.y + q.z * b.z + q.w * b.w < 0) q = {-q.x, -q.y, -q.z, -q.w};
      }
      clip.transforms.push_back(local);
    }
  }
  *out = std::move(clip);
  return Ok();
}

Error OpenSkeleton(const fs::path& path, MotionFile* motion) {
  *motion = {};
  motion->path = path.string();
  return Open(path, motion);
}

Error OpenMotion(const fs::path& path, MotionFile* motion) {
  if (Error e = OpenSkeleton(path, motion)) return e;
  if (motion->clip_names.empty()) return Fail(motion->path + ": holds no clip");
  if (motion->clip_names.size() == 1) {
    motion->clip_names[0] = path.stem().string() + " " + motion->clip_names[0];
  }
  return Ok();
}

Error ClipOf(const MotionFile& motion, size_t index, Clip* clip) {
  if (!motion.skeleton.clips.empty()) {
    *clip = motion.skeleton.clips[index];
    return Ok();
  }
  if (Error e = SampleClip(motion.document, motion.document.clips[index], motion.skeleton.joints, motion.joint_nodes,
                           motion.unscale, clip))
    return Fail(motion.path + ": " + e.message);
  return Ok();
}

fs::path ShippedClips() {
  const char* named = std::getenv("FLANEUR_CLIPS");
  if (named && *named) return named;
  std::error_code ec;
  const fs::path installed =
      fs::read_symlink("/proc/self/exe", ec).parent_path().parent_path() / "share/flaneur/clips/clips.glb";
  return fs::is_regular_file(installed, ec) ? installed : fs::path(FLANEUR_SHIPPED_CLIPS);
}

}  // namespace flaneur
