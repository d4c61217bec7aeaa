#include "runtime/base/png.h"

#include <cstdlib>

#include "runtime/base/file.h"

#ifndef __EMSCRIPTEN__
#include <libdeflate.h>

// stb's own takes five times as long for a fourth more bytes.
static unsigned char* DeflatedForPng(unsigned char* data, int count, int* deflated, int) {
  libdeflate_compressor* compressor = libdeflate_alloc_compressor(1);
  if (compressor == nullptr) return nullptr;
  const size_t bytes = static_cast<size_t>(count), most = libdeflate_zlib_compress_bound(compressor, bytes);
  auto* to = static_cast<unsigned char*>(std::malloc(most));
  if (to != nullptr) *deflated = static_cast<int>(libdeflate_zlib_compress(compressor, data, bytes, to, most));
  libdeflate_free_compressor(compressor);
  return to;
}
#define STBIW_ZLIB_COMPRESS DeflatedForPng
#endif

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace flaneur {

std::vector<uint8_t> EncodePng(int width_px, int height_px, int channels, const std::vector<uint8_t>& pixels) {
  int size = 0;
  unsigned char* png = stbi_write_png_to_mem(pixels.data(), width_px * channels, width_px, height_px, channels, &size);
  if (png == nullptr) return {};
  std::vector<uint8_t> bytes(png, png + size);
  std::free(png);
  return bytes;
}

std::vector<uint8_t> EncodeJpeg(int width_px, int height_px, int quality, const std::vector<uint8_t>& rgb) {
  std::vector<uint8_t> bytes;
  const auto append = [](void* to, void* data, int size) {
    const auto* from = static_cast<const uint8_t*>(data);
    auto* out = static_cast<std::vector<uint8_t>*>(to);
    out->insert(out->end(), from, from + size);
  };
  return stbi_write_jpg_to_func(append, &bytes, width_px, height_px, 3, rgb.data(), quality) != 0
             ? bytes
             : std::vector<uint8_t>{};
}

Error WritePng(const std::filesystem::path& path, int width_px, int height_px, const std::vector<uint8_t>& rgb) {
  const std::vector<uint8_t> png = EncodePng(width_px, height_px, 3, rgb);
  if (png.empty()) return Fail(path.string() + ": the picture cannot be encoded");
  return WriteFile(path, png);
}

}  // namespace flaneur
