// Clips of any file together with the skeleton that they were made for.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/io/gltf_document.h"
#include "pipeline/rig/humanoid.h"
#include "runtime/base/error.h"

namespace flaneur {

inline constexpr float kLongestClip_s = 60;  // of longer recordings only so much is looked at

struct MotionFile {
  std::string path;
  Avatar skeleton;                      // clips only those of a BVH file, which has one; meshes without triangles
  std::vector<NamedBone> told;          // by the file itself
  std::vector<std::string> clip_names;  // where the file holds one clip alone, the file's name stands before its own
  GltfDocument document;
  std::vector<int> joint_nodes;
  std::vector<Mat4> unscale;  // a joint: removes the scale that its node has at rest, and mirroring
};

// Opens glTF (VRM and VRMA too), BVH, and by Blender .fbx, .blend and .dae; a figure may be missing. Errors: as for
// ReadGltfScene, a BVH file that is none (names the line), no clip.
Error OpenMotion(const std::filesystem::path& path, MotionFile* motion);

// The same, of a file that may hold no clip; the names of its clips stay as they are.
Error OpenSkeleton(const std::filesystem::path& path, MotionFile* motion);

// One of its clips at 30 Hz, on the skeleton's joints; at most kLongestClip_s of it. Errors: too long for so many nodes
// and channels (kMostPoses of runtime/base/limits.h).
Error ClipOf(const MotionFile& motion, size_t index, Clip* clip);

// The file's clips for people that bring none, beside the program or in the source tree.
std::filesystem::path ShippedClips();

// Joints, skeleton and one clip of a glTF document: what OpenMotion and ReadAvatar share. `joints`: of these nodes,
// parents before children. Errors: as for ClipOf.
Error SampleClip(const GltfDocument& document, const DocumentClip& source, const std::vector<Joint>& joints,
                 const std::vector<int>& joint_nodes, const std::vector<Mat4>& unscale, Clip* clip);

// Takes the scale off a node's rest matrix, and the mirroring of one that mirrors.
Mat4 Unscaled(const Mat4& rest);

}  // namespace flaneur
