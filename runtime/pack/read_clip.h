// A glTF animation as skinning matrices at a constant rate. Internal to runtime/pack.
#pragma once
#include "runtime/pack/gltf_file.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {

inline constexpr float kClipRateHz = 30;  // close enough to interpolate linearly between for human motion

// A skin's joints and all nodes above them, for its clips: the file's other nodes don't matter to them.
struct Skin {
  std::vector<size_t> joints;       // nodes of the file
  std::vector<Mat4> inverse_binds;  // by joint
  std::vector<int> nodes;           // of the file, parents before their children
  std::vector<int> parent;          // by node here: index here; -1: none
  std::vector<size_t> joint_node;   // by joint: index here
};

// `skin` is an index into the file's skins.
Skin ReadSkin(const GltfFile& file, int skin);

std::vector<PackJoint> ReadSkeleton(const GltfFile& file, const Skin& skin);

// `animation` -1 gives one frame of the joints' rest pose.
PackClip ReadClip(const GltfFile& file, const Skin& skin, int animation);

}  // namespace flaneur
