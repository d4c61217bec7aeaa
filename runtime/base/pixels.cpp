#include "runtime/base/pixels.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <stb/stb_image.h>

#include "runtime/base/array.h"
#include "runtime/base/jpeg_tables.h"
#pragma GCC diagnostic pop

namespace flaneur {

std::optional<Pixels> DecodedSize(std::span<const uint8_t> bytes) {
  Pixels size;
  int channels = 0;
  if (!HasSoundHuffmanTables(bytes)) return std::nullopt;
  if (!stbi_info_from_memory(bytes.data(), Count(bytes), &size.width, &size.height, &channels)) return std::nullopt;
  return size;
}

std::optional<Pixels> Decoded(std::span<const uint8_t> bytes) {
  Pixels pixels;
  int channels = 0;
  if (!HasSoundHuffmanTables(bytes)) return std::nullopt;
  stbi_uc* data = stbi_load_from_memory(bytes.data(), Count(bytes), &pixels.width, &pixels.height, &channels, 4);
  if (data == nullptr) return std::nullopt;
  pixels.rgba.assign(data, data + 4 * static_cast<size_t>(pixels.width) * static_cast<size_t>(pixels.height));
  stbi_image_free(data);
  return pixels;
}

}  // namespace flaneur
