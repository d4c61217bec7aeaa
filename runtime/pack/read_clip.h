// A glTF animation as skinning matrices at a constant rate. Internal to runtime/pack.
#pragma once
#include "runtime/pack/gltf_file.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {

inline constexpr float kClipRateHz = 30;  // close enough to interpolate linearly between for human motion

std::vector<PackJoint> ReadSkeleton(const GltfFile& file, int skin);

// `skin` is an index into the file's skins; `animation` -1 gives one frame of the joints' rest pose.
PackClip ReadClip(const GltfFile& file, int skin, int animation);

}  // namespace flaneur
