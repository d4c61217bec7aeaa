#include "pipeline/impostor/atlas_layout.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "runtime/pack/texture.h"

namespace flaneur {
namespace {

constexpr int kCellStep_px = 4;  // a block of the compressed pictures
constexpr int kAtlasStep_px = 1 << (kAtlasLevels - 1);
constexpr int kMaxSide_px = 8192;  // what every desktop graphics card takes

int RoundedUp(int value, int step) { return (value + step - 1) / step * step; }

// At the origin of the atlas.
ImpostorCell Cropped(const ViewBounds& view, float texel_m, int border_px) {
  const auto first = [&](float at_m) { return static_cast<int>(std::floor(at_m / texel_m)) - border_px; };
  const int left = first(view.left_m), top = first(-view.top_m);
  const int right = -first(-view.right_m), bottom = -first(view.bottom_m);
  return {0, 0, RoundedUp(right - left, kCellStep_px), RoundedUp(bottom - top, kCellStep_px), -left, -top};
}

// Puts the cells on shelves, high ones first; the height that they take.
int FillShelves(int width_px, const std::vector<size_t>& order, std::vector<ImpostorCell>* cells) {
  int x = 0, top = 0, shelf = 0;
  for (size_t i : order) {
    ImpostorCell& cell = (*cells)[i];
    if (x + cell.width > width_px) x = 0, top += shelf, shelf = 0;
    cell.x = x;
    cell.y = top;
    x += cell.width;
    shelf = std::max(shelf, cell.height);
  }
  return top + shelf;
}

}  // namespace

bool LayOutCells(const std::vector<ViewBounds>& views, int border_px, ImpostorAtlas* atlas) {
  atlas->cells.clear();
  int widest = 0;
  for (const ViewBounds& view : views) {
    atlas->cells.push_back(Cropped(view, atlas->texel_m, border_px));
    widest = std::max(widest, atlas->cells.back().width);
  }
  std::vector<size_t> order(views.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return atlas->cells[a].height > atlas->cells[b].height; });
  int64_t least = -1;
  for (int width = RoundedUp(widest, kAtlasStep_px); width <= kMaxSide_px; width += kAtlasStep_px) {
    const int height = RoundedUp(FillShelves(width, order, &atlas->cells), kAtlasStep_px);
    const int64_t area = int64_t{width} * height;
    if (height > kMaxSide_px || (least >= 0 && area >= least)) continue;
    least = area;
    atlas->width_px = width;
    atlas->height_px = height;
  }
  if (least < 0) return false;
  FillShelves(atlas->width_px, order, &atlas->cells);
  for (ImpostorCell& cell : atlas->cells) cell.origin_x += cell.x, cell.origin_y += cell.y;
  return true;
}

size_t TextureMemory(const ImpostorAtlas& atlas) {
  size_t bytes = 0;
  for (int k = 0; k < kAtlasLevels; ++k) {
    const int width = atlas.width_px >> k, height = atlas.height_px >> k;
    bytes += LevelBytes(TextureFormat::kBc7Srgb, width, height) + LevelBytes(TextureFormat::kBc5, width, height) +
             LevelBytes(TextureFormat::kBc4, width, height);
    if (k > 0) bytes += LevelBytes(TextureFormat::kBc7, width, height) * (atlas.tint_regions ? 2 : 1);
  }
  return bytes;
}

}  // namespace flaneur
