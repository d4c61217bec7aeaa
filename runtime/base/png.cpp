#include "runtime/base/png.h"

#include <cstdlib>

#include "runtime/base/file.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace flaneur {

Error WritePng(const std::filesystem::path& path, int width_px, int height_px, const std::vector<uint8_t>& rgb) {
  int size = 0;
  unsigned char* png = stbi_write_png_to_mem(rgb.data(), width_px * 3, width_px, height_px, 3, &size);
  if (png == nullptr) return Fail(path.string() + ": the picture cannot be encoded");
  const Error error = WriteFile(path, {png, static_cast<size_t>(size)});
  std::free(png);
  return error;
}

}  // namespace flaneur
