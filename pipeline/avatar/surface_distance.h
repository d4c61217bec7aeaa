// Distance from points to a triangle surface: a tree of bounding boxes, four a node, over the triangles.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "runtime/base/math.h"

namespace flaneur {

class SurfaceTree {
 public:
  struct Nearest {
    float distance = 0;
    uint32_t triangle = 0;        // as they were given
    std::array<float, 3> shares;  // of its corners in the nearest point
  };

  // Keeps its own copy of the corners. At least one triangle.
  explicit SurfaceTree(std::vector<std::array<Vec3, 3>> triangles);

  // The same triangles, each moved to another place; the tree keeps its shape.
  void MoveTo(const std::vector<std::array<Vec3, 3>>& triangles);

  float Distance(Vec3 point) const;
  // `guess`: a triangle that may be near, which makes the search shorter.
  Nearest Find(Vec3 point, uint32_t guess = 0) const;
  // The greater of `distance` and the point's own, which is only worked out where it is greater.
  // `guess`: a triangle that may be near; out: one that is nearer.
  float AtLeast(Vec3 point, float distance, uint32_t* guess) const;

 private:
  using Four [[gnu::vector_size(16)]] = float;

  // Up to four parts, their bounds side by side so that all are looked at in one go.
  struct Node {
    std::array<Four, 3> min, max;     // by axis, one a part; nothing is near an unused one
    std::array<uint32_t, 4> first{};  // triangle of a leaf, else a node, which comes later
    std::array<uint32_t, 4> count{};  // triangles of a leaf, else 0
  };
  struct Range {
    uint32_t first = 0, count = 0;
  };

  // Halves the triangles by their centres along the longest side; returns the lower half's number.
  uint32_t Halve(Range range, const std::vector<Vec3>& centres);
  void Build(uint32_t node, Range range, const std::vector<Vec3>& centres);
  void Bound(Node* node, size_t part) const;
  void BoundAll();
  // Squared; ends early at `enough`. `best`: known so far, with `triangle`.
  float Search(Vec3 point, float best, float enough, uint32_t* triangle) const;

  std::vector<std::array<Vec3, 3>> triangles_;  // in the leaves' order
  std::vector<uint32_t> numbers_;               // of each as it was given
  std::vector<uint32_t> places_;                // where each went, by its number
  std::vector<Node> nodes_;
};

}  // namespace flaneur
