// Triangles of a person in a pose, and places on them that move along.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/core/mesh.h"
#include "runtime/base/math.h"

namespace flaneur {

using Triangles = std::vector<std::array<Vec3, 3>>;

// Of all meshes, one after the other; without a pose in the bind pose.
Triangles PosedTriangles(const std::vector<Mesh>& meshes, const std::vector<Mat4>* pose);

struct Place {
  uint32_t triangle = 0;
  std::array<float, 3> shares{};  // of its corners
};

inline Vec3 At(const std::array<Vec3, 3>& triangle, const std::array<float, 3>& shares) {
  return triangle[0] * shares[0] + triangle[1] * shares[1] + triangle[2] * shares[2];
}

// Evenly by area, rising by triangle, the same every time.
std::vector<Place> SpreadPlaces(const Triangles& triangles, int count);

}  // namespace flaneur
