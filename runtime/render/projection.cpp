#include "runtime/render/projection.h"

#include <algorithm>
#include <cmath>

namespace flaneur {

Mat4 LookMatrix(Vec3 eye, Vec3 ahead, Vec3 up) {
  const Vec3 z = Normalized(ahead * -1), x = Normalized(Cross(up, z)), y = Cross(z, x);
  Mat4 m;
  m.m[0] = {x.x, y.x, z.x, 0};
  m.m[1] = {x.y, y.y, z.y, 0};
  m.m[2] = {x.z, y.z, z.z, 0};
  m.m[3] = {-Dot(x, eye), -Dot(y, eye), -Dot(z, eye), 1};
  return m;
}

Mat4 Perspective(float fov_rad, float aspect, float near_m, float far_m) {
  const float f = 1 / std::tan(fov_rad / 2);
  Mat4 m;
  m.m[0] = {f, 0, 0, 0};
  m.m[1] = {0, f * aspect, 0, 0};
  m.m[2] = {0, 0, (far_m + near_m) / (near_m - far_m), -1};
  m.m[3] = {0, 0, 2 * far_m * near_m / (near_m - far_m), 0};
  return m;
}

Mat4 ShadowMatrix(Vec3 center, Vec3 to_sun, float half_width_m, float half_depth_m, int size_px) {
  const Vec3 up = std::abs(to_sun.y) > 0.99f ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Mat4 view = LookMatrix({0, 0, 0}, to_sun * -1, up);
  Vec3 c = TransformPoint(view, center);
  const float texel_m = 2 * half_width_m / static_cast<float>(size_px);
  c.x = std::floor(c.x / texel_m) * texel_m;
  c.y = std::floor(c.y / texel_m) * texel_m;
  Mat4 orthographic;
  orthographic.m[0][0] = orthographic.m[1][1] = 1 / half_width_m;
  orthographic.m[2][2] = -1 / half_depth_m;
  orthographic.m[3] = {-c.x / half_width_m, -c.y / half_width_m, c.z / half_depth_m, 1};
  return orthographic * view;
}

void Include(Vec3 p, Box* box) {
  box->low = {std::min(box->low.x, p.x), std::min(box->low.y, p.y), std::min(box->low.z, p.z)};
  box->high = {std::max(box->high.x, p.x), std::max(box->high.y, p.y), std::max(box->high.z, p.z)};
}

float Distance(const Box& b, Vec3 p) {
  return Length(Vec3{std::max({b.low.x - p.x, p.x - b.high.x, 0.0f}), std::max({b.low.y - p.y, p.y - b.high.y, 0.0f}),
                     std::max({b.low.z - p.z, p.z - b.high.z, 0.0f})});
}

Frustum FrustumOf(const Mat4& vp) {
  const auto row = [&](size_t r) { return Vec4{vp.m[0][r], vp.m[1][r], vp.m[2][r], vp.m[3][r]}; };
  const Vec4 w = row(3);
  Frustum planes;
  for (size_t r = 0; r < 3; ++r) {
    const Vec4 v = row(r);
    planes[2 * r] = {w.x + v.x, w.y + v.y, w.z + v.z, w.w + v.w};
    planes[2 * r + 1] = {w.x - v.x, w.y - v.y, w.z - v.z, w.w - v.w};
  }
  return planes;
}

namespace {

// How far the box reaches into the plane's inside; the box turned about its middle: how far all of it is inside.
float Reach(const Vec4& p, Vec3 low, Vec3 high) {
  return p.x * (p.x > 0 ? high.x : low.x) + p.y * (p.y > 0 ? high.y : low.y) + p.z * (p.z > 0 ? high.z : low.z) + p.w;
}

}  // namespace

bool MayTouch(const Frustum& frustum, const Box& box) {
  return std::all_of(frustum.begin(), frustum.end(), [&](const Vec4& p) { return Reach(p, box.low, box.high) >= 0; });
}

bool LiesWithin(const Frustum& frustum, const Box& box) {
  return std::all_of(frustum.begin(), frustum.end(), [&](const Vec4& p) { return Reach(p, box.high, box.low) >= 0; });
}

}  // namespace flaneur
