#include "pipeline/avatar/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace flaneur {
namespace {

constexpr uint32_t kLeafTriangles = 2;
constexpr float kFar = 1e30f;

Vec3 Min(Vec3 a, Vec3 b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3 Max(Vec3 a, Vec3 b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

float Axis(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

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
  centres.reserve(triangles_.size());
  for (const auto& t : triangles_) centres.push_back(t[0] + t[1] + t[2]);
  nodes_.reserve(triangles_.size() / kLeafTriangles + 1);
  nodes_.emplace_back();
  Build(0, {0, static_cast<uint32_t>(triangles_.size())}, centres);
  std::vector<std::array<Vec3, 3>> ordered;
  ordered.reserve(triangles_.size());
  places_.resize(numbers_.size());
  for (const uint32_t i : numbers_) {
    places_[i] = static_cast<uint32_t>(ordered.size());
    ordered.push_back(triangles_[i]);
  }
  triangles_ = std::move(ordered);
  BoundAll();
}

uint32_t SurfaceTree::Halve(Range range, const std::vector<Vec3>& centres) {
  const auto begin = numbers_.begin() + range.first;
  Vec3 min{kFar, kFar, kFar}, max = min * -1;
  for (uint32_t i = 0; i < range.count; ++i) {
    min = Min(min, centres[begin[i]]);
    max = Max(max, centres[begin[i]]);
  }
  const Vec3 size = max - min;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const uint32_t half = range.count / 2;
  std::nth_element(begin, begin + half, begin + range.count, [&](uint32_t a, uint32_t b) {
    const float x = Axis(centres[a], axis), y = Axis(centres[b], axis);
    return x != y ? x < y : a < b;
  });
  return half;
}

void SurfaceTree::Build(uint32_t node, Range range, const std::vector<Vec3>& centres) {
  std::array<Range, 4> parts{range};
  size_t count = 1;
  while (count < 4) {
    const auto largest =
        std::max_element(parts.begin(), parts.begin() + count, [](Range a, Range b) { return a.count < b.count; });
    if (largest->count <= kLeafTriangles) break;
    const uint32_t half = Halve(*largest, centres);
    parts[count++] = {largest->first + half, largest->count - half};
    largest->count = half;
  }
  for (size_t i = 0; i < count; ++i) {
    if (parts[i].count <= kLeafTriangles) {
      nodes_[node].first[i] = parts[i].first;
      nodes_[node].count[i] = parts[i].count;
      continue;
    }
    const auto child = static_cast<uint32_t>(nodes_.size());
    nodes_[node].first[i] = child;
    nodes_.emplace_back();
    Build(child, parts[i], centres);
  }
}

// Part `part` of the node; parts of later nodes must be bounded already.
void SurfaceTree::Bound(Node* node, size_t part) const {
  Vec3 min{kFar, kFar, kFar}, max = min * -1;
  const uint32_t first = node->first[part], count = node->count[part];
  for (uint32_t i = first; i < first + count; ++i) {
    for (const Vec3 p : triangles_[i]) {
      min = Min(min, p);
      max = Max(max, p);
    }
  }
  if (count == 0 && first > 0) {
    const Node& child = nodes_[first];
    for (size_t i = 0; i < 4; ++i) {
      min = Min(min, {child.min[0][i], child.min[1][i], child.min[2][i]});
      max = Max(max, {child.max[0][i], child.max[1][i], child.max[2][i]});
    }
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    node->min[axis][part] = Axis(min, static_cast<int>(axis));
    node->max[axis][part] = Axis(max, static_cast<int>(axis));
  }
}

void SurfaceTree::BoundAll() {
  for (size_t n = nodes_.size(); n-- > 0;) {
    for (size_t part = 0; part < 4; ++part) Bound(&nodes_[n], part);
  }
}

void SurfaceTree::MoveTo(const std::vector<std::array<Vec3, 3>>& triangles) {
  for (size_t i = 0; i < numbers_.size(); ++i) triangles_[i] = triangles[numbers_[i]];
  BoundAll();
}

float SurfaceTree::Search(Vec3 point, float best, float enough, uint32_t* triangle) const {
  struct Part {
    float squared;
    uint32_t first, count;
  };
  std::array<Part, 64> stack;  // three are left waiting a level; the tree quarters at each
  size_t depth = 0;
  stack[depth++] = {0, 0, 0};
  while (depth > 0 && best > enough) {
    const Part part = stack[--depth];
    if (part.squared >= best) continue;
    for (uint32_t i = part.first; i < part.first + part.count; ++i) {
      const float found = SquaredToTriangle(point, triangles_[i]);
      if (found >= best) continue;
      best = found;
      *triangle = i;
    }
    if (part.count > 0) continue;
    const Node& node = nodes_[part.first];
    Four squared{};
    for (size_t axis = 0; axis < 3; ++axis) {
      const float at = Axis(point, static_cast<int>(axis));
      const Four below = node.min[axis] - at, above = at - node.max[axis];
      Four outside = below > above ? below : above;
      outside = outside > 0 ? outside : Four{};
      squared += outside * outside;
    }
    // The nearest part comes last, to be taken first.
    const auto near = squared < best;
    const size_t bottom = depth;
    for (size_t i = 0; i < 4; ++i) {
      if (near[i] == 0) continue;
      size_t at = depth++;
      for (; at > bottom && stack[at - 1].squared < squared[i]; --at) stack[at] = stack[at - 1];
      stack[at] = {squared[i], node.first[i], node.count[i]};
    }
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
  const float enough = distance * distance, guessed = SquaredToTriangle(point, triangles_[triangle]);
  if (guessed <= enough) return distance;
  const float squared = Search(point, guessed, enough, &triangle);
  *guess = numbers_[triangle];
  return std::max(std::sqrt(squared), distance);
}

}  // namespace flaneur
