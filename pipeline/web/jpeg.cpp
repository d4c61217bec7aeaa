#include "pipeline/web/jpeg.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace flaneur {

std::vector<uint8_t> EncodeJpeg(const Pixels& pixels, int quality) {
  std::vector<uint8_t> rgb(static_cast<size_t>(pixels.width) * static_cast<size_t>(pixels.height) * 3), out;
  for (size_t i = 0; i < rgb.size(); ++i) rgb[i] = pixels.rgba[i / 3 * 4 + i % 3];
  const auto append = [](void* to, void* bytes, int count) {
    const auto* from = static_cast<const uint8_t*>(bytes);
    static_cast<std::vector<uint8_t>*>(to)->insert(static_cast<std::vector<uint8_t>*>(to)->end(), from, from + count);
  };
  const bool written = stbi_write_jpg_to_func(append, &out, pixels.width, pixels.height, 3, rgb.data(), quality) != 0;
  return written ? out : std::vector<uint8_t>();
}

}  // namespace flaneur
