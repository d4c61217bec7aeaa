// Directions around a viewer, in sectors: how full a view would be, whichever way the viewer looked.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/base/math.h"
#include "runtime/crowd/fast_math.h"

namespace flaneur {

constexpr int kSectors = 48;

// What each sector holds, anticlockwise.
template <class T>
using Sectors = std::array<T, kSectors>;

// The sector in which the direction of `off` lies, 0 to kSectors - 1.
inline int SectorOf(Vec2 off) { return static_cast<int>((AngleOf(off) / (2 * kPi) + 1) * kSectors) % kSectors; }

// How many sectors a view is wide, at least 1.
inline int SectorsOfView(float fov_rad) {
  return std::clamp(static_cast<int>(std::lround(fov_rad / (2 * kPi) * kSectors)), 1, kSectors);
}

// How many sectors a view touches at most: one more than its width, as it may begin within one.
inline int SectorsTouched(float fov_rad) {
  return std::clamp(static_cast<int>(std::ceil(fov_rad / (2 * kPi) * kSectors)) + 1, 1, kSectors);
}

// For each sector, the most that any view of `width` sectors over it holds.
template <class T>
Sectors<T> FullestOver(const Sectors<T>& held, int width) {
  Sectors<T> fullest{};
  T in_view{};
  for (int j = 0; j < width; ++j) in_view += held[static_cast<size_t>(j)];
  for (int first = 0; first < kSectors; ++first) {
    for (int j = 0; j < width; ++j) {
      T& most = fullest[static_cast<size_t>((first + j) % kSectors)];
      most = std::max(most, in_view);
    }
    in_view += held[static_cast<size_t>((first + width) % kSectors)] - held[static_cast<size_t>(first)];
  }
  return fullest;
}

// The most that any view holds.
template <class T>
T Fullest(const Sectors<T>& held, int width) {
  T most{}, in_view{};
  for (int j = 0; j < width; ++j) in_view += held[static_cast<size_t>(j)];
  for (int first = 0; first < kSectors; ++first) {
    most = std::max(most, in_view);
    in_view += held[static_cast<size_t>((first + width) % kSectors)] - held[static_cast<size_t>(first)];
  }
  return most;
}

}  // namespace flaneur
