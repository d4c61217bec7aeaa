// Cameras as matrices, and what they see. glTF axes (Y up); clip space is OpenGL's, depth -1 to 1.
#pragma once
#include <array>

#include "runtime/base/math.h"

namespace flaneur {

Mat4 LookMatrix(Vec3 eye, Vec3 ahead, Vec3 up);
Mat4 Perspective(float fov_horizontal_rad, float aspect, float near_m, float far_m);

// Looking along the light at a square around `center`, whose place is rounded to texels so that shadows don't crawl.
Mat4 ShadowMatrix(Vec3 center, Vec3 to_sun, float half_width_m, float half_depth_m, int size_px);

struct Box { Vec3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f}; };
void Include(Vec3 p, Box* box);
float Distance(const Box& box, Vec3 p);  // 0 inside

// Six planes: p is inside where dot(xyz, p) + w >= 0 for each.
using Frustum = std::array<Vec4, 6>;
Frustum FrustumOf(const Mat4& view_projection);
bool MayTouch(const Frustum& frustum, const Box& box);  // conservative: true for some that just miss

}  // namespace flaneur
