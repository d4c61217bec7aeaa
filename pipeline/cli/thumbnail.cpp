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

void CopyCell(const Pixels& from, int from_x, int width, int to_x, Pixels* to) {
  for (int y = 0; y < to->height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto* in = &from.rgba[static_cast<size_t>(y * from.width + from_x + x) * 4];
      auto* out = &to->rgba[static_cast<size_t>(y * to->width + to_x + x) * 4];
      if (in[3] > 0) std::copy(in, in + 4, out);  // the gutters' fill stays out
    }
  }
}

}  // namespace

std::vector<uint8_t> ImpostorThumbnail(const ImpostorAtlas& atlas) {
  const Pixels whole = Decoded(atlas.albedo);
  const int step = atlas.directions > 8 ? 2 : 1, cells = (atlas.directions + step - 1) / step;
  if (whole.width < atlas.directions * atlas.cell_width_px || whole.height < atlas.cell_height_px) return {};
  Pixels strip{cells * atlas.cell_width_px, atlas.cell_height_px, {}};
  strip.rgba.resize(static_cast<size_t>(strip.width) * static_cast<size_t>(strip.height) * 4);
  for (int i = 0; i < cells; ++i) {
    CopyCell(whole, i * step * atlas.cell_width_px, atlas.cell_width_px, i * atlas.cell_width_px, &strip);
  }
  Image png;
  if (EncodePng(strip, true, &png)) return {};
  return png.bytes;
}

}  // namespace flaneur
