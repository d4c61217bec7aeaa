#include "pipeline/avatar/posed_quadric.h"

namespace flaneur {

Affine SkinningOf(const std::array<uint16_t, 4>& joints, const std::array<float, 4>& weights,
                  const std::vector<Mat4>& matrices) {
  Affine out{};
  float sum = 0;
  for (size_t i = 0; i < 4; ++i) {
    if (!(weights[i] > 0)) continue;
    sum += weights[i];
    const Mat4& m = matrices[joints[i]];
    for (size_t k = 0; k < 12; ++k) out[k] += weights[i] * m.m[k % 4][k / 4];
  }
  return sum > 0 ? out : kIdentity;
}

void AddPulledBack(const Quadric& q, const Affine& affine, Quadric* sum) {
  double m[12];
  for (size_t i = 0; i < 12; ++i) m[i] = static_cast<double>(affine[i]);
  // Columns of A m, with the shift as the fourth; the linear part joins the latter.
  double a[3][4];
  for (size_t c = 0; c < 4; ++c) {
    a[0][c] = q.xx * m[c] + q.xy * m[4 + c] + q.xz * m[8 + c];
    a[1][c] = q.xy * m[c] + q.yy * m[4 + c] + q.yz * m[8 + c];
    a[2][c] = q.xz * m[c] + q.yz * m[4 + c] + q.zz * m[8 + c];
  }
  const auto product = [&](size_t r, size_t c) { return m[r] * a[0][c] + m[4 + r] * a[1][c] + m[8 + r] * a[2][c]; };
  const auto linear = [&](size_t c) { return m[c] * q.x + m[4 + c] * q.y + m[8 + c] * q.z; };
  sum->xx += product(0, 0);
  sum->xy += product(0, 1);
  sum->xz += product(0, 2);
  sum->yy += product(1, 1);
  sum->yz += product(1, 2);
  sum->zz += product(2, 2);
  sum->x += product(0, 3) + linear(0);
  sum->y += product(1, 3) + linear(1);
  sum->z += product(2, 3) + linear(2);
  sum->c += product(3, 3) + 2 * linear(3) + q.c;
}

DVec3 Minimizer(const Quadric& q, DVec3 anchor, double stiffness) {
  const double spring = stiffness * (q.xx + q.yy + q.zz) / 3;
  const double xx = q.xx + spring, yy = q.yy + spring, zz = q.zz + spring;
  // Solved for the way from the anchor, where the gradient is g.
  const DVec3 g{q.xx * anchor.x + q.xy * anchor.y + q.xz * anchor.z + q.x,
                q.xy * anchor.x + q.yy * anchor.y + q.yz * anchor.z + q.y,
                q.xz * anchor.x + q.yz * anchor.y + q.zz * anchor.z + q.z};
  const double cxx = yy * zz - q.yz * q.yz, cxy = q.xz * q.yz - q.xy * zz;
  const double cxz = q.xy * q.yz - q.xz * yy;
  const double determinant = xx * cxx + q.xy * cxy + q.xz * cxz;
  if (!(determinant > 0)) return anchor;
  const double cyy = xx * zz - q.xz * q.xz, cyz = q.xy * q.xz - xx * q.yz;
  const double czz = xx * yy - q.xy * q.xy;
  const DVec3 step{cxx * g.x + cxy * g.y + cxz * g.z, cxy * g.x + cyy * g.y + cyz * g.z,
                   cxz * g.x + cyz * g.y + czz * g.z};
  return anchor - step * (1 / determinant);
}

}  // namespace flaneur
