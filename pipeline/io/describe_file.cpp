#include "pipeline/io/describe_file.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <vector>

#include "pipeline/io/blender_import.h"
#include "pipeline/io/gltf_document.h"
#include "pipeline/io/gltf_pose.h"
#include "pipeline/io/motion_reader.h"
#include "pipeline/rig/rig.h"
#include "runtime/base/array.h"
#include "runtime/base/file.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

std::string Line(const char* format, ...) __attribute__((format(printf, 1, 2)));

std::string Line(const char* format, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return std::string(text) + "\n";
}

struct Extent {
  Vec3 min{1e30f, 1e30f, 1e30f}, max{-1e30f, -1e30f, -1e30f};
};

const char* AxisName(Vec3 way) {
  static constexpr const char* kNames[] = {"+X", "-X", "+Y", "-Y", "+Z", "-Z"};
  const float along[] = {way.x, -way.x, way.y, -way.y, way.z, -way.z};
  return kNames[std::max_element(along, along + 6) - along];
}

std::string Nodes(const GltfDocument& document) {
  std::string text = "nodes that show something:\n";
  const std::vector<Mat4> world = WorldMatrices(document);
  std::vector<bool> bone(document.nodes.size(), false);
  for (const DocumentSkin& skin : document.skins) {
    for (const int joint : skin.joints) At(bone, joint) = true;
  }
  for (const int i : document.order) {
    const DocumentNode& node = At(document.nodes, i);
    if (!node.in_scene || node.mesh < 0) continue;
    int triangles = 0;
    Extent extent;
    for (const auto& primitive : At(document.meshes, node.mesh).primitives) {
      triangles += TriangleCount(primitive.mesh);
      for (const Vec3 own : primitive.mesh.positions) {
        const Vec3 p = node.skin >= 0 ? own : TransformPoint(At(world, i), own);
        extent.min = {std::min(extent.min.x, p.x), std::min(extent.min.y, p.y), std::min(extent.min.z, p.z)};
        extent.max = {std::max(extent.max.x, p.x), std::max(extent.max.y, p.y), std::max(extent.max.z, p.z)};
      }
    }
    if (triangles == 0) continue;
    std::string hangs = node.skin >= 0 ? "skin " + std::to_string(node.skin) : "no bone";
    for (int a = i; a >= 0 && node.skin < 0; a = At(document.nodes, a).parent) {
      if (At(bone, a)) {
        hangs = "on bone " + OneLine(At(document.nodes, a).name);
        break;
      }
    }
    const Vec3 size = extent.max - extent.min;
    text += Line("  %-28s %7d triangles  %.2f x %.2f x %.2f  %s", OneLine(node.name).c_str(), triangles,
                 static_cast<double>(size.x), static_cast<double>(size.y), static_cast<double>(size.z), hangs.c_str());
  }
  return text;
}

std::string Clips(const MotionFile& motion) {
  if (motion.clip_names.empty()) return "no clips\n";
  std::string text = "clips:\n";
  for (size_t i = 0; i < motion.clip_names.size(); ++i) {
    float length_s = 0;
    if (!motion.skeleton.clips.empty()) length_s = motion.skeleton.clips[i].duration_s;
    else if (!motion.document.clips[i].channels.empty()) {
      const ClipSpan span = SpanOf(motion.document.clips[i]);
      length_s = span.end_s - span.start_s;
    }
    text += Line("  %-40s %6.2f s", OneLine(motion.clip_names[i]).c_str(), static_cast<double>(length_s));
  }
  return text;
}

std::string Body(const MotionFile& motion) {
  const std::vector<Joint>& joints = motion.skeleton.joints;
  const Pose rest = BindPose(joints);
  Humanoid h;
  std::string why;
  std::string text = Line("%zu bones and nodes above them", joints.size());
  if (!FindHumanoid(joints, rest.positions, motion.told, &h, &why))
    return text + Line("no human skeleton: %s", why.c_str());
  const auto name = [&](int joint) { return joint < 0 ? std::string("-") : OneLine(At(joints, joint).name); };
  text += Line("%s, by its %s:", h.quadruped ? "goes on four legs" : "a human skeleton",
               !motion.told.empty() ? "VRM bones"
               : h.by_shape         ? "shape"
                                    : "names");
  text += Line("  hips %s, head %s, %zu joints of the spine, %zu of the neck", name(h.hips).c_str(),
               name(h.head).c_str(), h.spine.size(), h.neck.size());
  for (const size_t side : {kLeft, kRight}) {
    const HumanoidArm& arm = h.arms[side];
    const HumanoidLeg& leg = h.legs[side];
    text += Line("  %s: arm %s, %s, %s; leg %s, %s, %s, %s", side == kLeft ? "left" : "right", name(arm.upper).c_str(),
                 name(arm.lower).c_str(), name(arm.hand).c_str(), name(leg.upper).c_str(), name(leg.lower).c_str(),
                 name(leg.foot).c_str(), name(leg.toes).c_str());
  }
  Vec3 up, forward;
  if (!FindStance(h, rest.positions, &up, &forward)) return text;
  return text + Line("  at rest: up is %s, facing %s", AxisName(up), AxisName(forward));
}

}  // namespace

Error DescribePersonFile(const std::filesystem::path& path, std::string* text) {
  MotionFile motion;
  if (Error e = OpenSkeleton(path, &motion)) return e;
  *text = path.string() + ":\n" + Nodes(motion.document) + Body(motion) + Clips(motion);
  return Ok();
}

}  // namespace flaneur
