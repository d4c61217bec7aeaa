#include "runtime/render/eyes.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

// At that place of the picture, -1 to 1, so far away as clip space's middle.
Vec3 Towards(const Mat4& inverse, float x, float y, Vec3 eye) {
  const auto row = [&](size_t r) { return inverse.m[0][r] * x + inverse.m[1][r] * y + inverse.m[3][r]; };
  const Vec3 point = Vec3{row(0), row(1), row(2)} * (1 / row(3));
  return Normalized(point - eye);
}

}  // namespace

EyesTogether Together(const std::vector<EyePicture>& eyes, float near_m, float far_m) {
  EyesTogether all;
  std::vector<Vec3> edges;
  for (const EyePicture& e : eyes) {
    const Mat4 inverse = Inverse(e.view_projection);
    all.eye = all.eye + e.eye * (1 / static_cast<float>(eyes.size()));
    for (float x : {-1.0f, 1.0f}) {
      for (float y : {-1.0f, 1.0f}) edges.push_back(Towards(inverse, x, y, e.eye));
    }
  }
  for (const Vec3& edge : edges) all.ahead = all.ahead + edge;
  all.ahead = Normalized(all.ahead);
  const Vec3 some_up = std::abs(all.ahead.y) > 0.99f ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 right = Normalized(Cross(all.ahead, some_up)), up = Cross(right, all.ahead);
  constexpr float kLeastAhead = 0.05f;  // wider than that no frustum is
  float wide = 0.1f, high = 0.1f, back_m = 0;
  for (const Vec3& edge : edges) {
    const float ahead = std::max(kLeastAhead, Dot(edge, all.ahead));
    wide = std::max(wide, std::abs(Dot(edge, right)) / ahead);
    high = std::max(high, std::abs(Dot(edge, up)) / ahead);
  }
  for (const EyePicture& e : eyes) {  // so far back that each of them is within
    const Vec3 off = e.eye - all.eye;
    const float ahead = Dot(off, all.ahead);
    back_m = std::max({back_m, std::abs(Dot(off, right)) / wide - ahead, std::abs(Dot(off, up)) / high - ahead});
  }
  all.eye = all.eye - all.ahead * back_m;
  all.view_projection =
      Perspective(2 * std::atan(wide), wide / high, near_m, far_m) * LookMatrix(all.eye, all.ahead, some_up);
  // The projection's first row is twice the near plane over its width, whatever the view turns it to.
  const EyePicture& first = eyes.front();
  const Mat4& m = first.view_projection;
  const float scale = Length(Vec3{m.m[0][0], m.m[1][0], m.m[2][0]});
  all.focal_px = scale * static_cast<float>(first.width_px) / 2;
  return all;
}

}  // namespace flaneur
