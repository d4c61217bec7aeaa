#include "runtime/base/math.h"

namespace flaneur {

Mat4 operator*(const Mat4& a, const Mat4& b) {
  Mat4 out;
  for (size_t c = 0; c < 4; ++c) {
    for (size_t r = 0; r < 4; ++r) {
      float sum = 0;
      for (size_t k = 0; k < 4; ++k) sum += a.m[k][r] * b.m[c][k];
      out.m[c][r] = sum;
    }
  }
  return out;
}

Vec3 TransformPoint(const Mat4& m, Vec3 p) { return TransformDirection(m, p) + Vec3{m.m[3][0], m.m[3][1], m.m[3][2]}; }

Vec3 TransformDirection(const Mat4& m, Vec3 d) {
  return {m.m[0][0] * d.x + m.m[1][0] * d.y + m.m[2][0] * d.z, m.m[0][1] * d.x + m.m[1][1] * d.y + m.m[2][1] * d.z,
          m.m[0][2] * d.x + m.m[1][2] * d.y + m.m[2][2] * d.z};
}

Mat4 FromTranslationRotationScale(Vec3 t, Quat q, Vec3 s) {
  const float xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const float xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const float wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  Mat4 out;
  out.m[0] = {(1 - 2 * (yy + zz)) * s.x, 2 * (xy + wz) * s.x, 2 * (xz - wy) * s.x, 0};
  out.m[1] = {2 * (xy - wz) * s.y, (1 - 2 * (xx + zz)) * s.y, 2 * (yz + wx) * s.y, 0};
  out.m[2] = {2 * (xz + wy) * s.z, 2 * (yz - wx) * s.z, (1 - 2 * (xx + yy)) * s.z, 0};
  out.m[3] = {t.x, t.y, t.z, 1};
  return out;
}

namespace {

// Cofactor of element (row, column) of the 4x4 matrix, from the 3x3 minor.
double Cofactor(const Mat4& m, size_t row, size_t column) {
  double minor[3][3];
  for (size_t r = 0, i = 0; r < 4; ++r) {
    if (r == row) continue;
    for (size_t c = 0, j = 0; c < 4; ++c) {
      if (c != column) minor[i][j++] = m.m[c][r];
    }
    ++i;
  }
  const double value = minor[0][0] * (minor[1][1] * minor[2][2] - minor[1][2] * minor[2][1]) -
                       minor[0][1] * (minor[1][0] * minor[2][2] - minor[1][2] * minor[2][0]) +
                       minor[0][2] * (minor[1][0] * minor[2][1] - minor[1][1] * minor[2][0]);
  return (row + column) % 2 == 0 ? value : -value;
}

}  // namespace

Mat4 Inverse(const Mat4& m) {
  double determinant = 0;
  for (size_t c = 0; c < 4; ++c) determinant += m.m[c][0] * Cofactor(m, 0, c);
  if (determinant == 0 || !std::isfinite(determinant)) return Mat4{};
  Mat4 out;
  for (size_t r = 0; r < 4; ++r) {
    for (size_t c = 0; c < 4; ++c) {
      out.m[r][c] = static_cast<float>(Cofactor(m, r, c) / determinant);
    }
  }
  return out;
}

Quat Normalized(Quat q) {
  const float length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(length > 0)) return Quat{};
  return {q.x / length, q.y / length, q.z / length, q.w / length};
}

Quat Slerp(Quat a, Quat b, float t) {
  float cosine = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
  const float sign = cosine < 0 ? -1.0f : 1.0f;
  cosine *= sign;
  float wa = 1 - t, wb = t;
  if (cosine < 0.9995f) {
    const float angle = std::acos(cosine);
    wa = std::sin((1 - t) * angle) / std::sin(angle);
    wb = std::sin(t * angle) / std::sin(angle);
  }
  wb *= sign;
  return Normalized(Quat{wa * a.x + wb * b.x, wa * a.y + wb * b.y, wa * a.z + wb * b.z, wa * a.w + wb * b.w});
}

}  // namespace flaneur
