#include "pipeline/avatar/atlas_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#define STB_IMAGE_RESIZE_IMPLEMENTATION
#define STB_IMAGE_RESIZE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_resize.h>
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

#include "runtime/base/png.h"
#include "runtime/base/srgb.h"

namespace flaneur {
namespace {

constexpr int kJpegQuality = 97;

size_t Index(const Pixels& pixels, int x, int y) {
  return 4 * (static_cast<size_t>(y) * static_cast<size_t>(pixels.width) + static_cast<size_t>(x));
}

uint8_t Byte(float share) { return static_cast<uint8_t>(std::lround(255 * std::clamp(share, 0.0f, 1.0f))); }

// What becomes of each value of a channel.
using Curve = std::array<uint8_t, 256>;

Curve ColorCurve(float factor) {
  Curve curve;
  for (size_t i = 0; i < curve.size(); ++i) {
    curve[i] = Byte(SrgbFromLinear(factor * LinearFromSrgb(static_cast<float>(i) / 255)));
  }
  return curve;
}

Curve AlphaCurve(const Material& material) {
  float factor = material.base_color.w;
  if (material.alpha == Material::Alpha::kMask) {
    factor *= 0.5f / std::max(material.alpha_cutoff, 0.01f);
  }
  Curve curve;
  for (size_t i = 0; i < curve.size(); ++i) {
    curve[i] = material.alpha == Material::Alpha::kOpaque ? uint8_t{255} : Byte(factor * static_cast<float>(i) / 255);
  }
  return curve;
}

void Append(void* bytes, void* data, int size) {
  const auto* first = static_cast<const uint8_t*>(data);
  auto* to = static_cast<std::vector<uint8_t>*>(bytes);
  to->insert(to->end(), first, first + size);
}

}  // namespace

Pixels Blank(int width_px, int height_px) {
  return {width_px, height_px,
          std::vector<uint8_t>(4 * static_cast<size_t>(width_px) * static_cast<size_t>(height_px), 255)};
}

Pixels Resized(const Pixels& from, int width_px, int height_px) {
  if (from.width == width_px && from.height == height_px) return from;
  Pixels to = Blank(width_px, height_px);
  stbir_resize(from.rgba.data(), from.width, from.height, 0, to.rgba.data(), to.width, to.height, 0, STBIR_TYPE_UINT8,
               4, 3, 0, STBIR_EDGE_WRAP, STBIR_EDGE_WRAP, STBIR_FILTER_BOX, STBIR_FILTER_BOX, STBIR_COLORSPACE_SRGB,
               nullptr);
  return to;
}

Pixels TimesBaseColor(Pixels pixels, const Material& material) {
  const std::array<Curve, 4> curves{ColorCurve(material.base_color.x), ColorCurve(material.base_color.y),
                                    ColorCurve(material.base_color.z), AlphaCurve(material)};
  for (size_t i = 0; i < pixels.rgba.size(); ++i) pixels.rgba[i] = curves[i % 4][pixels.rgba[i]];
  return pixels;
}

void CopyRepeated(const Pixels& from, PixelPlace first, PixelPlace to, PixelPlace size, Pixels* atlas) {
  const auto wrapped = [](int at, int length) { return ((at % length) + length) % length; };
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const uint8_t* pixel =
          &from.rgba[Index(from, wrapped(first.x + x, from.width), wrapped(first.y + y, from.height))];
      std::copy(pixel, pixel + 4, &atlas->rgba[Index(*atlas, to.x + x, to.y + y)]);
    }
  }
}

Image Encoded(const Pixels& pixels, bool alpha) {
  Image image;
  if (alpha) {
    image.mime_type = "image/png";
    image.bytes = EncodePng(pixels.width, pixels.height, 4, pixels.rgba);
  } else {
    image.mime_type = "image/jpeg";
    stbi_write_jpg_to_func(Append, &image.bytes, pixels.width, pixels.height, 4, pixels.rgba.data(), kJpegQuality);
  }
  return image;
}

}  // namespace flaneur
