// Distance from points to a triangle surface: a tree of bounding boxes over the triangles.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/base/math.h"

namespace flaneur {

class SurfaceTree {
 public:
  // Keeps its own copy of the corners. At least one triangle.
  explicit SurfaceTree(std::vector<std::array<Vec3, 3>> triangles);

  float Distance(Vec3 point) const;

 private:
  struct Box {
    Vec3 min, max;
    uint32_t first = 0,
             count = 0;  // leaf: triangles; inner node: count 0, children at first and first + 1
  };

  void Build(uint32_t box, uint32_t first, uint32_t count);

  std::vector<std::array<Vec3, 3>> triangles_;
  std::vector<Box> boxes_;
};

// The greatest distance of the points from the surface.
float GreatestDistance(const SurfaceTree& surface, std::span<const Vec3> points);

}  // namespace flaneur
