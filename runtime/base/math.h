// Small fixed-size linear algebra. Float, column-major matrices, column vectors: p' = m * p.
#pragma once
#include <array>
#include <cmath>

namespace flaneur {

inline constexpr float kPi = 3.14159265358979f;

struct Vec2 {
  float x = 0, y = 0;
};
struct Vec3 {
  float x = 0, y = 0, z = 0;
};
struct Vec4 {
  float x = 0, y = 0, z = 0, w = 0;
};
struct Quat {
  float x = 0, y = 0, z = 0, w = 1;
};  // unit quaternion, glTF order

// By reference: of a copy of both numbers at once, WebAssembly's compilers take each out again.
inline Vec2 operator+(const Vec2& a, const Vec2& b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2 operator-(const Vec2& a, const Vec2& b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2 operator*(const Vec2& a, float s) { return {a.x * s, a.y * s}; }
inline float Dot(const Vec2& a, const Vec2& b) { return a.x * b.x + a.y * b.y; }
inline float Cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }
inline float Length(const Vec2& a) { return std::sqrt(Dot(a, a)); }

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline float Dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 Cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline float Length(Vec3 a) { return std::sqrt(Dot(a, a)); }
// The zero vector stays zero.
inline Vec3 Normalized(Vec3 a) {
  const float length = Length(a);
  return length > 0 ? a * (1 / length) : a;
}

inline Vec4 operator+(Vec4 a, Vec4 b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
inline Vec4 operator-(Vec4 a, Vec4 b) { return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w}; }
inline Vec4 operator*(Vec4 a, float s) { return {a.x * s, a.y * s, a.z * s, a.w * s}; }

// m[column][row].
struct Mat4 {
  std::array<std::array<float, 4>, 4> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
};

Mat4 operator*(const Mat4& a, const Mat4& b);
Vec3 TransformPoint(const Mat4& m, Vec3 p);      // w = 1, no division
Vec3 TransformDirection(const Mat4& m, Vec3 d);  // w = 0
Mat4 FromTranslationRotationScale(Vec3 translation, Quat rotation, Vec3 scale);
// A singular matrix gives the identity.
Mat4 Inverse(const Mat4& m);
Quat Normalized(Quat q);
// Spherical interpolation along the shorter arc, t in [0, 1].
Quat Slerp(Quat a, Quat b, float t);

// Our ground plane (x east, y north, z up) and glTF's axes (X right, Y up, Z towards the viewer).
inline Vec3 GltfFromGround(Vec3 p) { return {p.x, p.z, -p.y}; }
inline Vec3 GroundFromGltf(Vec3 p) { return {p.x, -p.z, p.y}; }

}  // namespace flaneur
