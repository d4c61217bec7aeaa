// Cameras as matrices, and what they see. glTF axes (Y up); clip space is OpenGL's, depth -1 to 1.
#pragma once
#include <array>

#include "runtime/base/math.h"

namespace flaneur {

Mat4 LookMatrix(Vec3 eye, Vec3 ahead, Vec3 up);
Mat4 Perspective(float fov_horizontal_rad, float aspect, float near_m, float far_m);

// Looking along the light at a square around `center`, whose place is rounded to texels so that shadows don't crawl.
Mat4 ShadowMatrix(Vec3 center, Vec3 to_sun, float half_width_m, float half_depth_m, int size_px);

// In clip space, without the depth: 1 / w tells which is nearer.
struct ClipPoint {
  float x, y, w;
};
inline ClipPoint ToClip(const Mat4& m, Vec3 p) {
  const auto row = [&](size_t r) { return m.m[0][r] * p.x + m.m[1][r] * p.y + m.m[2][r] * p.z + m.m[3][r]; };
  return {row(0), row(1), row(3)};
}
// Beyond one of the view's four sides with all corners.
inline bool IsBesideTheView(const std::array<ClipPoint, 3>& t) {
  const auto all = [&](auto beyond) { return beyond(t[0]) && beyond(t[1]) && beyond(t[2]); };
  return all([](const ClipPoint& c) { return c.x < -c.w; }) || all([](const ClipPoint& c) { return c.x > c.w; }) ||
         all([](const ClipPoint& c) { return c.y < -c.w; }) || all([](const ClipPoint& c) { return c.y > c.w; });
}

struct Box {
  Vec3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
};
void Include(Vec3 p, Box* box);
float Distance(const Box& box, Vec3 p);  // 0 inside

// Six planes: p is inside where dot(xyz, p) + w >= 0 for each.
using Frustum = std::array<Vec4, 6>;
Frustum FrustumOf(const Mat4& view_projection);
bool MayTouch(const Frustum& frustum, const Box& box);  // conservative: true for some that just miss
bool LiesWithin(const Frustum& frustum, const Box& box);

}  // namespace flaneur
