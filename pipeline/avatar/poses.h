// The poses of a person that levels are made for and measured in.
#pragma once
#include <vector>

#include "pipeline/core/avatar.h"

namespace flaneur {

// Skinning matrices of `count` moments of the walk, evenly spread; none without a walk.
std::vector<std::vector<Mat4>> WalkPoses(const Avatar& avatar, int count);

// Positions, skin and triangles only: what a pose is worked out from, without the rest's cost.
std::vector<Mesh> Shapes(const std::vector<Mesh>& meshes);

std::vector<Mesh> Posed(const std::vector<Mesh>& meshes, const std::vector<Mat4>& matrices);

}  // namespace flaneur
