// A clip as glTF keeps it: for each joint and property only the keys that are needed.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"

namespace flaneur {

struct KeyChannel {
  size_t joint = 0;
  std::string path;          // translation, rotation or scale
  std::vector<float> times;  // seconds, rising; the last is the clip's duration
  std::vector<Vec4> values;  // one a time; w only of a rotation
};

// By joint the distance, in the bind pose, of the farthest vertex that it moves.
std::vector<float> JointReaches(std::span<const Joint> joints, std::span<const Mesh> meshes);

// Leaves out keys that interpolation restores, and channels that only hold the joint's rest
// transform: what the joint moves, as far as `reaches_m`, moves wrong by at most `error_m` for
// that. As few keys as that allows, at values fitted to all that are left out; the first and the last
// stay. Busy channels share their times where that takes fewer bytes.
std::vector<KeyChannel> ReduceKeys(const Clip& clip, std::span<const Joint> joints,
                                   std::span<const float> reaches_m, float error_m);

}  // namespace flaneur
