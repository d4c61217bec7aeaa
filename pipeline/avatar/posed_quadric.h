// Quadric error (Garland and Heckbert 1997) of a skinned vertex over several poses. In each pose
// the error is a quadric in posed space; as skinning is affine in the bind position, their sum is
// one quadric in bind space, so that the best place of a vertex for all poses is found at once.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/base/math.h"

namespace flaneur {

struct DVec3 {
  double x = 0, y = 0, z = 0;
};

inline DVec3 operator+(DVec3 a, DVec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline DVec3 operator-(DVec3 a, DVec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline DVec3 operator*(DVec3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double Dot(DVec3 a, DVec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline DVec3 Cross(DVec3 a, DVec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline DVec3 ToDouble(Vec3 v) { return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)}; }
inline Vec3 ToFloat(DVec3 v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

// p -> row . p + shift, three rows of four numbers.
using Affine = std::array<float, 12>;
inline constexpr Affine kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

// How a vertex of these joints and weights moves; one without weights stays.
Affine SkinningOf(const std::array<uint16_t, 4>& joints, const std::array<float, 4>& weights,
                  const std::vector<Mat4>& matrices);

inline DVec3 Apply(const Affine& m, DVec3 p) {
  const auto row = [&](size_t r) {
    return static_cast<double>(m[4 * r]) * p.x + static_cast<double>(m[4 * r + 1]) * p.y +
           static_cast<double>(m[4 * r + 2]) * p.z + static_cast<double>(m[4 * r + 3]);
  };
  return {row(0), row(1), row(2)};
}

// Sum of weighted squared distances from planes: p' A p + 2 b p + c, A symmetric.
struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  double x = 0, y = 0, z = 0, c = 0;
};

inline Quadric operator+(const Quadric& a, const Quadric& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy, a.yz + b.yz,
          a.zz + b.zz, a.x + b.x,   a.y + b.y,   a.z + b.z,   a.c + b.c};
}

// Squared distance from the plane through `point` across `n`, times `weight`; n has unit length.
inline Quadric PlaneQuadric(DVec3 n, DVec3 point, double weight) {
  const double d = -Dot(n, point);
  const DVec3 w = n * weight;
  return {w.x * n.x, w.x * n.y, w.x * n.z, w.y * n.y, w.y * n.z, w.z * n.z, w.x * d, w.y * d, w.z * d, weight * d * d};
}

// Squared distance from `point`, times `weight`.
inline Quadric PointQuadric(DVec3 p, double w) {
  return {w, 0, 0, w, 0, w, -w * p.x, -w * p.y, -w * p.z, w * Dot(p, p)};
}

inline double Evaluate(const Quadric& q, DVec3 p) {
  const double quadratic =
      p.x * (q.xx * p.x + 2 * (q.xy * p.y + q.xz * p.z)) + p.y * (q.yy * p.y + 2 * q.yz * p.z) + p.z * q.zz * p.z;
  return quadratic + 2 * (q.x * p.x + q.y * p.y + q.z * p.z) + q.c;
}

// Adds to `sum` the quadric of p -> q(m p).
void AddPulledBack(const Quadric& q, const Affine& m, Quadric* sum);

// Where the quadric is least, drawn towards `anchor` where planes do not tell: by a spring of
// `stiffness` times the mean stiffness of the planes.
DVec3 Minimizer(const Quadric& q, DVec3 anchor, double stiffness);

}  // namespace flaneur
