#include "pipeline/core/pixels.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace flaneur {

std::optional<Pixels> Decoded(const Image& image) {
  Pixels pixels;
  int channels = 0;
  stbi_uc* data = stbi_load_from_memory(image.bytes.data(), static_cast<int>(image.bytes.size()),
                                        &pixels.width, &pixels.height, &channels, 4);
  if (data == nullptr) return std::nullopt;
  pixels.rgba.assign(
      data, data + 4 * static_cast<size_t>(pixels.width) * static_cast<size_t>(pixels.height));
  stbi_image_free(data);
  return pixels;
}

}  // namespace flaneur
