#include "runtime/render/occlusion.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace flaneur {
namespace {

constexpr float kNear_m = 0.05f;
constexpr int kTilesAcross = kOcclusionWidth / kTile, kTilesUp = kOcclusionHeight / kTile;
constexpr float kWidth = kOcclusionWidth, kHeight = kOcclusionHeight;

struct Corner {
  float x, y, nearness;
};  // in pixels

Corner OnScreen(const ClipPoint& c) {
  const float nearness = 1 / c.w;
  return {(c.x * nearness + 1) * 0.5f * kWidth, (c.y * nearness + 1) * 0.5f * kHeight, nearness};
}

ClipPoint Between(const ClipPoint& a, const ClipPoint& b) {
  const float t = (kNear_m - a.w) / (b.w - a.w);
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), kNear_m};
}

// Whose corners go round anticlockwise: the others are not drawn.
bool FacesTheEye(const ClipPoint& a, const ClipPoint& b, const ClipPoint& c) {
  return a.x * (b.y * c.w - b.w * c.y) + b.x * (c.y * a.w - c.w * a.y) + c.x * (a.y * b.w - a.w * b.y) > 0;
}

// Row by row, from edge to edge: which pixels' centres lie inside.
void Fill(Corner a, Corner b, Corner c, OcclusionMap* map) {
  if (a.y > b.y) std::swap(a, b);
  if (b.y > c.y) std::swap(b, c);
  if (a.y > b.y) std::swap(a, b);
  const float area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  if (!(std::abs(area) > 1e-6f)) return;
  const float by_x = ((b.nearness - a.nearness) * (c.y - a.y) - (c.nearness - a.nearness) * (b.y - a.y)) / area;
  const float by_y = ((b.x - a.x) * (c.nearness - a.nearness) - (c.x - a.x) * (b.nearness - a.nearness)) / area;
  const int first = static_cast<int>(std::ceil(std::max(a.y, 0.0f) - 0.5f));
  const int last = static_cast<int>(std::floor(std::min(c.y, kHeight) - 0.5f));
  const float long_slope = (c.x - a.x) / (c.y - a.y);
  for (int y = std::max(first, 0); y <= last; ++y) {
    const float at = static_cast<float>(y) + 0.5f;
    const bool upper = at >= b.y;
    const Corner& from = upper ? b : a;
    const Corner& to = upper ? c : b;
    const float height = to.y - from.y;
    const float short_x = height > 0 ? from.x + (to.x - from.x) * (at - from.y) / height : from.x;
    const float long_x = a.x + long_slope * (at - a.y);
    const float low = std::clamp(std::min(short_x, long_x), 0.0f, kWidth),
                high = std::clamp(std::max(short_x, long_x), 0.0f, kWidth);
    const int left = static_cast<int>(std::ceil(low - 0.5f)), right = static_cast<int>(std::ceil(high - 0.5f));
    float nearness = a.nearness + by_x * (static_cast<float>(left) + 0.5f - a.x) + by_y * (at - a.y);
    float* row = &map->nearness[static_cast<size_t>(y * kOcclusionWidth)];
    for (int x = left; x < right; ++x, nearness += by_x) row[x] = std::max(row[x], nearness);
  }
}

void AddWall(const ClipPoint* corners, OcclusionMap* map) {
  std::array<ClipPoint, 4> kept;
  size_t count = 0;
  for (size_t i = 0; i < 3; ++i) {
    const ClipPoint &a = corners[i], &b = corners[(i + 1) % 3];
    if (a.w >= kNear_m) kept[count++] = a;
    if ((a.w >= kNear_m) != (b.w >= kNear_m)) kept[count++] = Between(a, b);
  }
  if (count < 3) return;
  std::array<Corner, 4> screen;
  for (size_t i = 0; i < count; ++i) screen[i] = OnScreen(kept[i]);
  for (size_t i = 1; i + 1 < count; ++i) Fill(screen[0], screen[i], screen[i + 1], map);
}

}  // namespace

void ClearOcclusion(const Mat4& view_projection, OcclusionMap* map) {
  map->view_projection = view_projection;
  map->nearness.assign(static_cast<size_t>(kOcclusionWidth) * kOcclusionHeight, 0);
  map->farthest.assign(static_cast<size_t>(kTilesAcross) * kTilesUp, 0);
}

void AddWalls(std::span<const Vec3> positions, std::span<const uint32_t> corners, OcclusionMap* map) {
  for (size_t i = 0; i + 2 < corners.size(); i += 3) {
    std::array<ClipPoint, 3> clip;
    for (size_t k = 0; k < 3; ++k) clip[k] = ToClip(map->view_projection, positions[corners[i + k]]);
    if (!FacesTheEye(clip[0], clip[1], clip[2])) continue;
    if (std::max({clip[0].w, clip[1].w, clip[2].w}) < kNear_m || IsBesideTheView(clip)) continue;
    AddWall(clip.data(), map);
  }
}

void FinishOcclusion(OcclusionMap* map) {
  for (int ty = 0; ty < kTilesUp; ++ty) {
    for (int tx = 0; tx < kTilesAcross; ++tx) {
      float least = 1e30f;
      for (int y = ty * kTile; y < (ty + 1) * kTile; ++y) {
        const float* row = &map->nearness[static_cast<size_t>(y * kOcclusionWidth + tx * kTile)];
        for (int x = 0; x < kTile; ++x) least = std::min(least, row[x]);
      }
      map->farthest[static_cast<size_t>(ty * kTilesAcross + tx)] = least;
    }
  }
}

bool MayBeSeen(const OcclusionMap& map, const Box& box, bool finished) {
  float left = 1e30f, right = -1e30f, low = 1e30f, high = -1e30f, nearness = 0;
  const ClipPoint corner = ToClip(map.view_projection, box.low);
  const Vec3 size = box.high - box.low;
  const auto edge = [&](size_t axis, float length) {
    const auto& column = map.view_projection.m[axis];
    return ClipPoint{column[0] * length, column[1] * length, column[3] * length};
  };
  const ClipPoint edges[] = {edge(0, size.x), edge(1, size.y), edge(2, size.z)};
  for (int k = 0; k < 8; ++k) {
    ClipPoint c = corner;
    for (int axis = 0; axis < 3; ++axis) {
      if (k >> axis & 1) c = {c.x + edges[axis].x, c.y + edges[axis].y, c.w + edges[axis].w};
    }
    if (c.w < kNear_m) return true;
    const Corner s = OnScreen(c);
    left = std::min(left, s.x), right = std::max(right, s.x), low = std::min(low, s.y), high = std::max(high, s.y);
    nearness = std::max(nearness, s.nearness);
  }
  if (right < 0 || left > kWidth || high < 0 || low > kHeight) return false;
  const int x0 = std::max(0, static_cast<int>(std::max(left, 0.0f)) - 1),
            x1 = static_cast<int>(std::min(right + 1, kWidth - 1));
  const int y0 = std::max(0, static_cast<int>(std::max(low, 0.0f)) - 1),
            y1 = static_cast<int>(std::min(high + 1, kHeight - 1));
  for (int ty = y0 / kTile; ty <= y1 / kTile; ++ty) {
    for (int tx = x0 / kTile; tx <= x1 / kTile; ++tx) {
      if (finished && map.farthest[static_cast<size_t>(ty * kTilesAcross + tx)] > nearness) continue;
      for (int y = std::max(y0, ty * kTile); y <= std::min(y1, ty * kTile + kTile - 1); ++y) {
        for (int x = std::max(x0, tx * kTile); x <= std::min(x1, tx * kTile + kTile - 1); ++x) {
          if (map.nearness[static_cast<size_t>(y * kOcclusionWidth + x)] <= nearness) return true;
        }
      }
    }
  }
  return false;
}

}  // namespace flaneur
