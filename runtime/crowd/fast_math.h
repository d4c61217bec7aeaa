// Elementary functions by arithmetic alone: the same bits on every machine, whatever its C library, and cheap. Float.
#pragma once
#include <cmath>
#include <cstdint>
#include <cstring>

#include "runtime/base/math.h"

namespace flaneur {

// Into -pi ... pi; for angles that are off by a few turns at most.
inline float WrapAngle(float a) {
  while (a > kPi) a -= 2 * kPi;
  while (a < -kPi) a += 2 * kPi;
  return a;
}

inline Vec2 ClampLength(Vec2 v, float most) {
  const float length2 = Dot(v, v);
  return length2 > most * most ? v * (most / std::sqrt(length2)) : v;
}

// To the nearest whole number, halves away from zero, as std::lround says it by a call of a page's own.
inline int Rounded(float a) {
  const int whole = static_cast<int>(a);
  const float rest = a - static_cast<float>(whole);
  return whole + (rest >= 0.5f ? 1 : 0) - (rest <= -0.5f ? 1 : 0);
}

// Of length 1; zero for what is as good as zero.
inline Vec2 Unit(Vec2 v) {
  const float length = Length(v);
  return length > 1e-6f ? v * (1 / length) : Vec2{};
}

// Anticlockwise from +x, to 2e-6 radians; 0 for the zero vector. By Abramowitz and Stegun's form 4.4.49.
inline float AngleOf(Vec2 v) {
  const float x = std::abs(v.x), y = std::abs(v.y);
  const float high = x > y ? x : y, low = x > y ? y : x;
  if (high <= 0) return 0;
  const float t = low / high, t2 = t * t;
  float angle = 0.0028662257f;
  angle = angle * t2 - 0.0161657367f;
  angle = angle * t2 + 0.0429096138f;
  angle = angle * t2 - 0.0752896400f;
  angle = angle * t2 + 0.1065626393f;
  angle = angle * t2 - 0.1420889944f;
  angle = angle * t2 + 0.1999355085f;
  angle = angle * t2 - 0.3333314528f;
  angle = angle * t2 * t + t;
  if (y > x) angle = 0.5f * kPi - angle;
  if (v.x < 0) angle = kPi - angle;
  return v.y < 0 ? -angle : angle;
}

// Unit vector of an angle, to 3e-6; for angles that are off by a few turns at most.
inline Vec2 DirectionOf(float angle_rad) {
  float a = WrapAngle(angle_rad);
  float sign = 1;  // of the cosine, once the angle lies within a quarter turn of +x or -x
  if (a > 0.5f * kPi) a = kPi - a, sign = -1;
  else if (a < -0.5f * kPi) a = -kPi - a, sign = -1;
  const float s = a * a;
  const float sine = a * (1 + s * (-1.0f / 6 + s * (1.0f / 120 + s * (-1.0f / 5040 + s * (1.0f / 362880)))));
  const float cosine =
      1 + s * (-0.5f + s * (1.0f / 24 + s * (-1.0f / 720 + s * (1.0f / 40320 - s * (1.0f / 3628800)))));
  return {sign * cosine, sine};
}

// e^-x for x >= 0, to 3 parts in a million; 0 beyond 80.
inline float DecayOf(float x) {
  if (x > 80) return 0;
  const float power = x * 1.44269504f;
  const int whole = static_cast<int>(power);
  const float f = (power - static_cast<float>(whole)) * 0.693147181f;  // e^-x = 2^-whole e^-f, f in 0 ... ln 2
  const float rest = 1 - f * (1 - f * (0.5f - f * (1.0f / 6 - f * (1.0f / 24 - f * (1.0f / 120 - f * (1.0f / 720))))));
  const uint32_t bits = static_cast<uint32_t>(127 - whole) << 23;
  float scale;
  std::memcpy(&scale, &bits, sizeof scale);
  return rest * scale;
}

}  // namespace flaneur
