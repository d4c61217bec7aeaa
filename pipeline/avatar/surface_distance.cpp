#include "pipeline/avatar/surface_distance.h"

#include <algorithm>
#include <utility>

namespace flaneur {
namespace {

constexpr uint32_t kLeafTriangles = 6;

Vec3 Min(Vec3 a, Vec3 b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3 Max(Vec3 a, Vec3 b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

float Axis(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

float SquaredToBox(Vec3 p, Vec3 min, Vec3 max) {
  const Vec3 outside = Max(Max(min - p, p - max), Vec3{});
  return Dot(outside, outside);
}

// Squared distance to the segment a b.
float SquaredToSegment(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 along = b - a;
  const float length2 = Dot(along, along);
  const float t = length2 > 0 ? std::clamp(Dot(p - a, along) / length2, 0.0f, 1.0f) : 0.0f;
  const Vec3 d = p - (a + along * t);
  return Dot(d, d);
}

// Where the foot of the perpendicular lies inside it is the plane that is nearest, else an edge.
float SquaredToTriangle(Vec3 p, const std::array<Vec3, 3>& t) {
  const Vec3 normal = Cross(t[1] - t[0], t[2] - t[0]);
  const float area2 = Dot(normal, normal);
  bool inside = area2 > 0;
  for (size_t i = 0; inside && i < 3; ++i) {
    const Vec3 a = t[i], b = t[(i + 1) % 3];
    inside = Dot(Cross(b - a, p - a), normal) >= 0;
  }
  if (inside) {
    const float height = Dot(p - t[0], normal);
    return height * height / area2;
  }
  return std::min({SquaredToSegment(p, t[0], t[1]), SquaredToSegment(p, t[1], t[2]),
                   SquaredToSegment(p, t[2], t[0])});
}

}  // namespace

SurfaceTree::SurfaceTree(std::vector<std::array<Vec3, 3>> triangles)
    : triangles_(std::move(triangles)) {
  boxes_.reserve(triangles_.size());
  boxes_.emplace_back();
  Build(0, 0, static_cast<uint32_t>(triangles_.size()));
}

// Halves the triangles by their centres along the longest side.
void SurfaceTree::Build(uint32_t box, uint32_t first, uint32_t count) {
  Vec3 min{1e30f, 1e30f, 1e30f}, max{-1e30f, -1e30f, -1e30f};
  for (uint32_t i = first; i < first + count; ++i) {
    for (const Vec3 p : triangles_[i]) {
      min = Min(min, p);
      max = Max(max, p);
    }
  }
  boxes_[box].min = min;
  boxes_[box].max = max;
  if (count <= kLeafTriangles) {
    boxes_[box].first = first;
    boxes_[box].count = count;
    return;
  }
  const Vec3 size = max - min;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto begin = triangles_.begin() + first;
  const uint32_t half = count / 2;
  std::nth_element(begin, begin + half, begin + count, [axis](const auto& a, const auto& b) {
    return Axis(a[0] + a[1] + a[2], axis) < Axis(b[0] + b[1] + b[2], axis);
  });
  const uint32_t children = static_cast<uint32_t>(boxes_.size());
  boxes_[box].first = children;
  boxes_.resize(boxes_.size() + 2);
  Build(children, first, half);
  Build(children + 1, first + half, count - half);
}

float SurfaceTree::Distance(Vec3 point) const {
  float best = 1e30f;
  std::array<std::pair<float, uint32_t>, 64> stack;  // deep enough: the tree halves at each level
  size_t depth = 0;
  stack[depth++] = {SquaredToBox(point, boxes_[0].min, boxes_[0].max), 0};
  while (depth > 0) {
    const auto [squared, index] = stack[--depth];
    if (squared >= best) continue;
    const Box& box = boxes_[index];
    for (uint32_t i = box.first; i < box.first + box.count; ++i) {
      best = std::min(best, SquaredToTriangle(point, triangles_[i]));
    }
    if (box.count > 0) continue;
    std::pair<float, uint32_t> near{0, box.first}, far{0, box.first + 1};
    for (auto* child : {&near, &far}) {
      child->first = SquaredToBox(point, boxes_[child->second].min, boxes_[child->second].max);
    }
    if (far.first < near.first) std::swap(near, far);
    stack[depth++] = far;
    stack[depth++] = near;
  }
  return std::sqrt(best);
}

float GreatestDistance(const SurfaceTree& surface, std::span<const Vec3> points) {
  float greatest = 0;
  for (const Vec3 p : points) greatest = std::max(greatest, surface.Distance(p));
  return greatest;
}

}  // namespace flaneur
