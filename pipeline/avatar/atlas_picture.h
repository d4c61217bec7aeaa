// Picture of a material atlas. Colours are sRGB.
#pragma once
#include "pipeline/core/mesh.h"
#include "runtime/base/pixels.h"

namespace flaneur {

struct PixelPlace {
  int x = 0, y = 0;
};

// White and opaque.
Pixels Blank(int width_px, int height_px);

// Averaged in linear light; the picture repeats beyond its edges.
Pixels Resized(const Pixels& from, int width_px, int height_px);

// Times the material's base colour. Alpha is 1 where the material is opaque, and passes 0.5 where a
// mask's passes its cutoff.
Pixels TimesBaseColor(Pixels pixels, const Material& material);

// Copies `size` pixels that start at `first` of the picture, which repeats in all directions.
void CopyRepeated(const Pixels& from, PixelPlace first, PixelPlace to, PixelPlace size, Pixels* atlas);

// PNG with alpha, else JPEG.
Image Encoded(const Pixels& pixels, bool alpha);

}  // namespace flaneur
