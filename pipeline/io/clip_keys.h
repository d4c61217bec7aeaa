// A clip as glTF keeps it: for each joint and property only the keys that are needed, and each of
// them no more exact than what it moves.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"

namespace flaneur {

struct KeyChannel {
  size_t joint = 0;
  std::string path;              // translation, rotation or scale
  std::vector<float> knots;      // where its keys are, counted in the clip's own; just 0 for what
                                 // stands still
  std::vector<float> times;      // the same in seconds
  std::vector<Vec4> values;      // one a knot, as they are read back; w only of a rotation
  std::vector<uint8_t> rounded;  // the values as meshopt's filters QUATERNION (8 bytes a rotation)
                                 // and EXPONENTIAL (12 bytes) take them; empty where exact
};

// By joint the distance, in the bind pose, of the farthest vertex that it moves.
std::vector<float> JointReaches(std::span<const Joint> joints, std::span<const Mesh> meshes);

// Every key of whatever moves, exact.
std::vector<KeyChannel> AllKeys(const Clip& clip, std::span<const Joint> joints);

// As few keys a channel, and as few bits a key, as keep what the joint moves, as far as
// `reaches_m`, within `error_m` of where it was for that channel alone; none where the joint's rest
// transform does. Keys are evenly spaced or where all channels of the clip bend, so that many share
// their times. The first and the last value are equal where the clip's are.
std::vector<KeyChannel> ReduceKeys(const Clip& clip, std::span<const Joint> joints, std::span<const float> reaches_m,
                                   float error_m);

// The same with an error that all channels together hold: no vertex of the meshes is farther than
// `error_m` from where it was at any of the clip's keys (of many vertices a few hundred are looked
// at).
std::vector<KeyChannel> ReduceKeysTogether(const Clip& clip, std::span<const Joint> joints,
                                           std::span<const Mesh> meshes, float error_m);

}  // namespace flaneur
