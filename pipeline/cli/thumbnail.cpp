#include "pipeline/cli/thumbnail.h"

#include <algorithm>

#include "pipeline/impostor/atlas_image.h"

namespace flaneur {
namespace {

void CopyCell(const Pixels& from, const ImpostorCell& cell, int to_x, int to_y, Pixels* to) {
  for (int y = 0; y < cell.height; ++y) {
    for (int x = 0; x < cell.width; ++x) {
      const auto* in = &from.rgba[static_cast<size_t>((cell.y + y) * from.width + cell.x + x) * 4];
      auto* out = &to->rgba[static_cast<size_t>((to_y + y) * to->width + to_x + x) * 4];
      if (in[3] > 0) std::copy(in, in + 4, out);  // the gutters' fill stays out
    }
  }
}

}  // namespace

std::vector<uint8_t> ImpostorThumbnail(const ImpostorAtlas& atlas) {
  const std::optional<Pixels> whole = Decoded(atlas.albedo.bytes);
  if (!whole || whole->width != atlas.width_px || whole->height != atlas.height_px) return {};
  const int step = atlas.directions > 8 ? 2 : 1;
  Pixels strip;
  for (int d = 0; d < atlas.directions; d += step) {
    const ImpostorCell& cell = atlas.cells[CellIndex(atlas, 0, 0, d)];
    strip.width += cell.width;
    strip.height = std::max(strip.height, cell.height);
  }
  strip.rgba.resize(static_cast<size_t>(strip.width) * static_cast<size_t>(strip.height) * 4);
  int left = 0;
  for (int d = 0; d < atlas.directions; d += step) {
    const ImpostorCell& cell = atlas.cells[CellIndex(atlas, 0, 0, d)];
    CopyCell(*whole, cell, left, strip.height - cell.height, &strip);
    left += cell.width;
  }
  Image png;
  if (EncodePng(strip, true, &png)) return {};
  return png.bytes;
}

}  // namespace flaneur
