#include "pipeline/cli/thumbnail.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include <algorithm>

#include "pipeline/impostor/atlas_image.h"

namespace flaneur {
namespace {

Pixels Decoded(const Image& image) {
  Pixels pixels;
  int channels = 0;
  stbi_uc* data = stbi_load_from_memory(image.bytes.data(), static_cast<int>(image.bytes.size()), &pixels.width,
                                        &pixels.height, &channels, 4);
  if (data == nullptr) return {};
  pixels.rgba.assign(data, data + static_cast<size_t>(pixels.width) * static_cast<size_t>(pixels.height) * 4);
  stbi_image_free(data);
  return pixels;
}

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
  const Pixels whole = Decoded(atlas.albedo);
  if (whole.width != atlas.width_px || whole.height != atlas.height_px) return {};
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
    CopyCell(whole, cell, left, strip.height - cell.height, &strip);
    left += cell.width;
  }
  Image png;
  if (EncodePng(strip, true, &png)) return {};
  return png.bytes;
}

}  // namespace flaneur
