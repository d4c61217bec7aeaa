// Picture of a material atlas. Colours are sRGB, alpha straight; the upper left corner comes first.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/core/mesh.h"

namespace flaneur {

struct Picture {
  int width = 0, height = 0;
  std::vector<uint8_t> rgba;
};

struct PixelPlace {
  int x = 0, y = 0;
};

// White and opaque.
Picture Blank(int width_px, int height_px);

// None where the bytes are no PNG or JPEG that can be read.
std::optional<Picture> Decoded(const Image& image);

// Averaged in linear light; the picture repeats beyond its edges.
Picture Resized(const Picture& from, int width_px, int height_px);

// Times the material's base colour. Alpha is 1 where the material is opaque, and passes 0.5 where a
// mask's passes its cutoff.
Picture Tinted(Picture pixels, const Material& material);

// Copies `size` pixels that start at `first` of the picture, which repeats in all directions.
void CopyRepeated(const Picture& from, PixelPlace first, PixelPlace to, PixelPlace size,
                  Picture* atlas);

// PNG with alpha, else JPEG.
Image Encoded(const Picture& pixels, bool alpha);

}  // namespace flaneur
