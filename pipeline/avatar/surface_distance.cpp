#include "pipeline/avatar/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace flaneur {
namespace {

constexpr uint32_t kLeafTriangles = 4;
constexpr float kFar = 1e30f;

Vec3 Min(Vec3 a, Vec3 b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3 Max(Vec3 a, Vec3 b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

float Axis(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

inline float SquaredToBox(Vec3 p, Vec3 min, Vec3 max) {
  const Vec3 outside = Max(Max(min - p, p - max), Vec3{});
  return Dot(outside, outside);
}

// The triangle's point nearest to p, by the region of its plane that p is above (Ericson 2005,
// Real-Time Collision Detection, 5.1.5).
std::array<float, 3> SharesOfNearest(Vec3 p, const std::array<Vec3, 3>& t) {
  const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
  const float d1 = Dot(ab, ap), d2 = Dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const Vec3 bp = p - t[1];
  const float d3 = Dot(ab, bp), d4 = Dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const float u = d1 - d3 > 0 ? d1 / (d1 - d3) : 0;
    return {1 - u, u, 0};
  }
  const Vec3 cp = p - t[2];
  const float d5 = Dot(ab, cp), d6 = Dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const float u = d2 - d6 > 0 ? d2 / (d2 - d6) : 0;
    return {1 - u, 0, u};
  }
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const float sum = (d4 - d3) + (d5 - d6), u = sum > 0 ? (d4 - d3) / sum : 0;
    return {0, 1 - u, u};
  }
  const float sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

float SquaredToTriangle(Vec3 p, const std::array<Vec3, 3>& t) {
  const std::array<float, 3> shares = SharesOfNearest(p, t);
  // From differences, so that small distances keep their digits.
  const Vec3 d = (p - t[0]) - ((t[1] - t[0]) * shares[1] + (t[2] - t[0]) * shares[2]);
  return Dot(d, d);
}

}  // namespace

SurfaceTree::SurfaceTree(std::vector<std::array<Vec3, 3>> triangles)
    : triangles_(std::move(triangles)), numbers_(triangles_.size()) {
  std::iota(numbers_.begin(), numbers_.end(), 0u);
  std::vector<Vec3> centres;
  for (const auto& t : triangles_) centres.push_back(t[0] + t[1] + t[2]);
  boxes_.reserve(triangles_.size());
  boxes_.emplace_back();
  Build(0, 0, static_cast<uint32_t>(triangles_.size()), &centres);
  std::vector<std::array<Vec3, 3>> ordered;
  ordered.reserve(triangles_.size());
  places_.resize(numbers_.size());
  for (const uint32_t i : numbers_) {
    places_[i] = static_cast<uint32_t>(ordered.size());
    ordered.push_back(triangles_[i]);
  }
  triangles_ = std::move(ordered);
}

// Halves the triangles by their centres along the longest side.
void SurfaceTree::Build(uint32_t box, uint32_t first, uint32_t count, std::vector<Vec3>* centres) {
  Vec3 min{1e30f, 1e30f, 1e30f}, max{-1e30f, -1e30f, -1e30f};
  for (uint32_t i = first; i < first + count; ++i) {
    for (const Vec3 p : triangles_[numbers_[i]]) {
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
  const auto begin = numbers_.begin() + first;
  const uint32_t half = count / 2;
  std::nth_element(begin, begin + half, begin + count, [&](uint32_t a, uint32_t b) {
    const float x = Axis((*centres)[a], axis), y = Axis((*centres)[b], axis);
    return x != y ? x < y : a < b;
  });
  const uint32_t children = static_cast<uint32_t>(boxes_.size());
  boxes_[box].first = children;
  boxes_.resize(boxes_.size() + 2);
  Build(children, first, half, centres);
  Build(children + 1, first + half, count - half, centres);
}

void SurfaceTree::MoveTo(const std::vector<std::array<Vec3, 3>>& triangles) {
  for (size_t i = 0; i < numbers_.size(); ++i) triangles_[i] = triangles[numbers_[i]];
  for (size_t b = boxes_.size(); b-- > 0;) {  // children come after their parents
    Box& box = boxes_[b];
    if (box.count == 0) {
      const Box &left = boxes_[box.first], &right = boxes_[box.first + 1];
      box.min = Min(left.min, right.min);
      box.max = Max(left.max, right.max);
      continue;
    }
    box.min = {kFar, kFar, kFar};
    box.max = box.min * -1;
    for (uint32_t i = box.first; i < box.first + box.count; ++i) {
      for (const Vec3 p : triangles_[i]) {
        box.min = Min(box.min, p);
        box.max = Max(box.max, p);
      }
    }
  }
}

float SurfaceTree::Search(Vec3 point, float best, float enough, uint32_t* triangle) const {
  std::array<std::pair<float, uint32_t>, 64> stack;  // deep enough: the tree halves at each level
  size_t depth = 0;
  stack[depth++] = {SquaredToBox(point, boxes_[0].min, boxes_[0].max), 0};
  while (depth > 0 && best > enough) {
    const auto [squared, index] = stack[--depth];
    if (squared >= best) continue;
    const Box& box = boxes_[index];
    for (uint32_t i = box.first; i < box.first + box.count; ++i) {
      const float found = SquaredToTriangle(point, triangles_[i]);
      if (found >= best) continue;
      best = found;
      *triangle = i;
    }
    if (box.count > 0) continue;
    std::pair<float, uint32_t> near{0, box.first}, far{0, box.first + 1};
    for (auto* child : {&near, &far}) {
      child->first = SquaredToBox(point, boxes_[child->second].min, boxes_[child->second].max);
    }
    if (far.first < near.first) std::swap(near, far);
    if (far.first < best) stack[depth++] = far;
    if (near.first < best) stack[depth++] = near;
  }
  return best;
}

float SurfaceTree::Distance(Vec3 point) const {
  uint32_t triangle = 0;
  return std::sqrt(Search(point, kFar, 0, &triangle));
}

SurfaceTree::Nearest SurfaceTree::Find(Vec3 point, uint32_t guess) const {
  uint32_t triangle = guess < places_.size() ? places_[guess] : 0;
  const float squared = Search(point, SquaredToTriangle(point, triangles_[triangle]), 0, &triangle);
  return {std::sqrt(squared), numbers_[triangle], SharesOfNearest(point, triangles_[triangle])};
}

float SurfaceTree::AtLeast(Vec3 point, float distance, uint32_t* guess) const {
  uint32_t triangle = places_[*guess];
  const float enough = distance * distance,
              guessed = SquaredToTriangle(point, triangles_[triangle]);
  if (guessed <= enough) return distance;
  const float squared = Search(point, guessed, enough, &triangle);
  *guess = numbers_[triangle];
  return std::max(std::sqrt(squared), distance);
}

}  // namespace flaneur
