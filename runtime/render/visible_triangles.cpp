#include "runtime/render/visible_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace flaneur {
namespace {

constexpr float kBehind_m = 0.002f;
constexpr float kNear_m = 0.05f;        // what comes nearer is drawn in any case
constexpr float kSlack_px = 1.0f / 32;  // corners are rounded before they are drawn
constexpr float kNearer = 1.004f;       // what lies on a wall is not behind it
constexpr int kFewPixels = 6;           // so many are looked at one by one

struct Corner {
  float x, y, nearness;
};  // in pixels; nearness: 1 / w
using Corners = std::array<Corner, 3>;
struct Area {
  int left, right, low, high;
};  // of pixels, the last included

// The last pixel whose middle is not beyond `at`. The library's rounding is a call for every number.
int LastMiddle(float at) {
  constexpr int kFar_px = 8192;
  constexpr auto kFar = static_cast<float>(kFar_px);
  return static_cast<int>(std::clamp(at, -kFar, kFar) + (kFar - 0.5f)) - kFar_px;
}
int FirstMiddle(float at) { return -LastMiddle(1 - at); }

// The pixels whose middles lie within the triangle's bounds.
Area PixelsIn(const Corners& t) {
  return {FirstMiddle(std::min({t[0].x, t[1].x, t[2].x}) - kSlack_px),
          LastMiddle(std::max({t[0].x, t[1].x, t[2].x}) + kSlack_px),
          FirstMiddle(std::min({t[0].y, t[1].y, t[2].y}) - kSlack_px),
          LastMiddle(std::max({t[0].y, t[1].y, t[2].y}) + kSlack_px)};
}

bool ReachesAny(const Corners& t, const Area& pixels) {
  const float around = (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[2].x - t[0].x) * (t[1].y - t[0].y) < 0 ? -1.0f : 1.0f;
  for (int y = pixels.low; y <= pixels.high; ++y) {
    for (int x = pixels.left; x <= pixels.right; ++x) {
      bool within = true;
      for (size_t k = 0; k < 3; ++k) {
        const Corner &a = t[k], &b = t[(k + 1) % 3];
        const float dx = b.x - a.x, dy = b.y - a.y;
        const float inward = dx * (static_cast<float>(y) + 0.5f - a.y) - dy * (static_cast<float>(x) + 0.5f - a.x);
        within &= around * inward >= -kSlack_px * (std::abs(dx) + std::abs(dy));
      }
      if (within) return true;
    }
  }
  return false;
}

// By the centres of the map's pixels with one more all around.
bool IsHidden(const Corners& t, const TriangleSight& sight) {
  const float across = static_cast<float>(kOcclusionWidth) / static_cast<float>(sight.width_px);
  const float up = static_cast<float>(kOcclusionHeight) / static_cast<float>(sight.height_px);
  const auto map_px = [](float at, int size) { return std::clamp(static_cast<int>(at), 0, size - 1); };
  const int left = map_px(std::min({t[0].x, t[1].x, t[2].x}) * across - 1, kOcclusionWidth);
  const int right = map_px(std::max({t[0].x, t[1].x, t[2].x}) * across + 1, kOcclusionWidth);
  const int low = map_px(std::min({t[0].y, t[1].y, t[2].y}) * up - 1, kOcclusionHeight);
  const int high = map_px(std::max({t[0].y, t[1].y, t[2].y}) * up + 1, kOcclusionHeight);
  const float nearness = std::max({t[0].nearness, t[1].nearness, t[2].nearness}) * kNearer;
  for (int y = low; y <= high; ++y) {
    const float* row = &sight.walls->nearness[static_cast<size_t>(y * kOcclusionWidth)];
    for (int x = left; x <= right; ++x) {
      if (row[x] <= nearness) return false;
    }
  }
  return true;
}

}  // namespace

bool TurnsItsBack(const std::array<Vec3, 3>& corners, Vec3 eye) {
  const Vec3 n = Cross(corners[1] - corners[0], corners[2] - corners[0]);
  const float in_front = Dot(n, eye - corners[0]);
  return in_front < 0 && in_front * in_front > kBehind_m * kBehind_m * Dot(n, n);
}

bool MayBeSeen(const std::array<Vec3, 3>& corners, const TriangleSight& sight) {
  const Mat4& m = sight.walls->view_projection;
  const std::array<ClipPoint, 3> clip{ToClip(m, corners[0]), ToClip(m, corners[1]), ToClip(m, corners[2])};
  if (IsBesideTheView(clip)) return false;
  if (std::min({clip[0].w, clip[1].w, clip[2].w}) < kNear_m) return true;
  const float half_width = 0.5f * static_cast<float>(sight.width_px),
              half_height = 0.5f * static_cast<float>(sight.height_px);
  Corners t;
  for (size_t k = 0; k < 3; ++k) {
    const float nearness = 1 / clip[k].w;
    t[k] = {(clip[k].x * nearness + 1) * half_width, (clip[k].y * nearness + 1) * half_height, nearness};
  }
  const Area pixels = PixelsIn(t);
  if (pixels.left > pixels.right || pixels.low > pixels.high || IsHidden(t, sight)) return false;
  return (pixels.right - pixels.left + 1) * (pixels.high - pixels.low + 1) > kFewPixels || ReachesAny(t, pixels);
}

}  // namespace flaneur
