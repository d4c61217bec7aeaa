// Pictures of an impostor atlas: from Blender's layers to 8 bits a channel, and the fill between
// silhouettes.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "pipeline/core/mesh.h"
#include "runtime/base/error.h"

namespace flaneur {

// 8-bit RGBA, rows from the top.
struct Pixels {
  int width = 0, height = 0;
  std::vector<uint8_t> rgba;
};

// The two pictures of an atlas, of one size.
struct AtlasPixels {
  Pixels albedo;  // sRGB, alpha = coverage
  Pixels normal;  // normal * 0.5 + 0.5, alpha = depth
};

// One picture's layers as Blender wrote them, into the atlas from row `first_row` on; what is not
// covered stays 0. Errors: unreadable file, another width than the atlas, a missing layer.
Error ReadLayers(const std::filesystem::path& exr, int first_row, float depth_range_m,
                 AtlasPixels* atlas);

// Spreads the colours and normals of covered texels (albedo's alpha > 0) over the others of their
// cell: eight rings, each texel the mean of its known neighbours, and further out the mean of the
// covered ones. So neither linear filtering nor mip levels mix in a colour that is not the
// person's. Albedo's alpha stays. A cell without a covered texel stays as it is.
void FillGutters(int cell_width, int cell_height, AtlasPixels* atlas);

// Share of the texels with any coverage.
double FillRate(const Pixels& albedo);

// Straight alpha. Errors: what OpenImageIO says.
Error EncodePng(const Pixels& pixels, bool srgb, Image* image);

}  // namespace flaneur
