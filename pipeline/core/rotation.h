// Rotations as unit quaternions, where runtime/base/math.h has no function for them.
#pragma once
#include "runtime/base/math.h"

namespace flaneur {

// The rotation b, then a.
Quat Product(Quat a, Quat b);
Quat Conjugate(Quat q);
Vec3 Rotated(Quat q, Vec3 v);

// The shortest turn that brings direction `from` to direction `to`; of opposite ones about any axis across.
Quat ArcBetween(Vec3 from, Vec3 to);

// About a unit axis.
Quat TurnAbout(Vec3 axis, float angle_rad);

// Of an orthonormal, right-handed basis: where x, y and z go.
Quat QuatFromBasis(Vec3 x, Vec3 y, Vec3 z);

// Of the matrix's upper left part, without its scale; that of a singular one is the identity.
Quat RotationOf(const Mat4& matrix);

// Between two directions, 0 to pi.
float AngleBetween(Vec3 a, Vec3 b);

// By how much q turns, 0 to pi.
float AngleOf(Quat q);

// The axis times the angle, which is at most pi.
Vec3 RotationVector(Quat q);

}  // namespace flaneur
