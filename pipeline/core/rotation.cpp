#include "pipeline/core/rotation.h"

#include <algorithm>
#include <cmath>

namespace flaneur {

Quat Product(Quat a, Quat b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

Quat Conjugate(Quat q) { return {-q.x, -q.y, -q.z, q.w}; }

Vec3 Rotated(Quat q, Vec3 v) {
  const Vec3 axis{q.x, q.y, q.z};
  const Vec3 t = Cross(axis, v) * 2;
  return v + t * q.w + Cross(axis, t);
}

Quat ArcBetween(Vec3 from, Vec3 to) {
  const Vec3 a = Normalized(from), b = Normalized(to);
  const float cosine = Dot(a, b);
  if (cosine < -0.99999f) {
    const Vec3 across = std::abs(a.x) < 0.6f ? Cross(a, {1, 0, 0}) : Cross(a, {0, 1, 0});
    return TurnAbout(Normalized(across), kPi);
  }
  const Vec3 axis = Cross(a, b);
  return Normalized(Quat{axis.x, axis.y, axis.z, 1 + cosine});
}

Quat TurnAbout(Vec3 axis, float angle_rad) {
  const float s = std::sin(angle_rad / 2);
  return {axis.x * s, axis.y * s, axis.z * s, std::cos(angle_rad / 2)};
}

// The branch with the largest component keeps precision.
Quat QuatFromBasis(Vec3 x, Vec3 y, Vec3 z) {
  const float trace = x.x + y.y + z.z;
  if (trace > 0) {
    const float s = 2 * std::sqrt(trace + 1);
    return {(y.z - z.y) / s, (z.x - x.z) / s, (x.y - y.x) / s, s / 4};
  }
  if (x.x > y.y && x.x > z.z) {
    const float s = 2 * std::sqrt(1 + x.x - y.y - z.z);
    return {s / 4, (x.y + y.x) / s, (z.x + x.z) / s, (y.z - z.y) / s};
  }
  if (y.y > z.z) {
    const float s = 2 * std::sqrt(1 + y.y - x.x - z.z);
    return {(x.y + y.x) / s, s / 4, (y.z + z.y) / s, (z.x - x.z) / s};
  }
  const float s = 2 * std::sqrt(1 + z.z - x.x - y.y);
  return {(z.x + x.z) / s, (y.z + z.y) / s, s / 4, (x.y - y.x) / s};
}

Quat RotationOf(const Mat4& matrix) {
  const auto column = [&](size_t c) { return Vec3{matrix.m[c][0], matrix.m[c][1], matrix.m[c][2]}; };
  const Vec3 x = Normalized(column(0));
  const Vec3 y = Normalized(column(1) - x * Dot(x, column(1)));
  const Vec3 z = Cross(x, y);
  if (!(Length(x) > 0.5f) || !(Length(y) > 0.5f)) return {};
  return Normalized(QuatFromBasis(x, y, z));
}

float AngleBetween(Vec3 a, Vec3 b) { return std::acos(std::clamp(Dot(Normalized(a), Normalized(b)), -1.0f, 1.0f)); }

float AngleOf(Quat q) { return 2 * std::atan2(std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z), std::abs(q.w)); }

Vec3 RotationVector(Quat q) {
  const float sign = q.w < 0 ? -1.0f : 1.0f;
  const Vec3 axis = Vec3{q.x, q.y, q.z} * sign;
  return Normalized(axis) * AngleOf(q);
}

}  // namespace flaneur
