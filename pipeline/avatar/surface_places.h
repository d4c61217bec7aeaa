// Triangles of a person in a pose, and places on them that move along.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/avatar/wedge_surface.h"
#include "pipeline/core/mesh.h"
#include "runtime/base/math.h"

namespace flaneur {

using Triangles = std::vector<std::array<Vec3, 3>>;

// Of all meshes, one after the other; without a pose in the bind pose.
Triangles PosedTriangles(const std::vector<Mesh>& meshes, const std::vector<Mat4>* pose);

// Of all faces, one after the other, in the bind pose.
Triangles BindTriangles(const WedgeSurface& surface);

// Of length 1; zero where the triangle has no extent.
inline Vec3 FaceNormal(const std::array<Vec3, 3>& t) { return Normalized(Cross(t[1] - t[0], t[2] - t[0])); }

struct SurfacePlace {
  uint32_t triangle = 0;
  std::array<float, 3> shares{};  // of its corners
};

inline Vec3 At(const std::array<Vec3, 3>& triangle, const std::array<float, 3>& shares) {
  return triangle[0] * shares[0] + triangle[1] * shares[1] + triangle[2] * shares[2];
}

// Evenly by area, rising by triangle, the same every time.
std::vector<SurfacePlace> SpreadPlaces(const Triangles& triangles, int count);

}  // namespace flaneur
