#include "runtime/likeness/compare.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/base/math.h"
#include "runtime/base/srgb.h"

namespace flaneur {
namespace {

struct Lab {
  double l, a, b;
};

double LabCurve(double t) {
  constexpr double kEdge = 6.0 / 29;
  return t > kEdge * kEdge * kEdge ? std::cbrt(t) : t / (3 * kEdge * kEdge) + 4.0 / 29;
}

Lab LabFromSrgb(const uint8_t* rgb) {
  static const auto kLinear = [] {
    std::array<double, 256> table{};
    for (size_t i = 0; i < table.size(); ++i) table[i] = LinearFromSrgb(static_cast<double>(i) / 255);
    return table;
  }();
  const double r = kLinear[rgb[0]], g = kLinear[rgb[1]], b = kLinear[rgb[2]];
  const double x = LabCurve((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.95047);
  const double y = LabCurve(0.2126729 * r + 0.7151522 * g + 0.0721750 * b);
  const double z = LabCurve((0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / 1.08883);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Vec3 NormalAt(const Portrait& portrait, size_t pixel) {
  const uint8_t* n = &portrait.normals[4 * pixel];
  const float half = static_cast<float>(n[3]) / 2;
  return Normalized(
      Vec3{static_cast<float>(n[0]) - half, static_cast<float>(n[1]) - half, static_cast<float>(n[2]) - half});
}

double AngleDegrees(Vec3 a, Vec3 b) {
  return std::atan2(static_cast<double>(Length(Cross(a, b))), static_cast<double>(Dot(a, b))) * 180 /
         static_cast<double>(kPi);
}

bool Covers(const Portrait& portrait, size_t pixel) { return portrait.normals[4 * pixel + 3] >= 128; }

}  // namespace

double DeltaE(const uint8_t* rgb_a, const uint8_t* rgb_b) {
  const Lab a = LabFromSrgb(rgb_a), b = LabFromSrgb(rgb_b);
  return std::sqrt((a.l - b.l) * (a.l - b.l) + (a.a - b.a) * (a.a - b.a) + (a.b - b.b) * (a.b - b.b));
}

Likeness Compare(const Portrait& full, const Portrait& other) {
  Likeness sum;
  size_t in_full = 0, in_both = 0, in_either = 0;
  const size_t pixels = std::min(full.normals.size(), other.normals.size()) / 4;
  for (size_t i = 0; i < pixels; ++i) {
    const bool a = Covers(full, i), b = Covers(other, i);
    if (!a && !b) continue;
    ++in_either;
    if (!a) continue;
    const double delta_e = DeltaE(&full.rgba[4 * i], &other.rgba[4 * i]);
    ++in_full;
    sum.delta_e_whole += delta_e;
    if (!b) continue;
    ++in_both;
    sum.delta_e += delta_e;
    sum.normal_deg += AngleDegrees(NormalAt(full, i), NormalAt(other, i));
  }
  if (in_both == 0) return {};
  const auto both = static_cast<double>(in_both);
  return {sum.delta_e / both, sum.delta_e_whole / static_cast<double>(in_full), both / static_cast<double>(in_either),
          sum.normal_deg / both};
}

}  // namespace flaneur
