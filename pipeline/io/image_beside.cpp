#include "pipeline/io/image_beside.h"

#include <algorithm>
#include <initializer_list>

#include "pipeline/core/child_policy.h"
#include "pipeline/io/webp_picture.h"
#include "runtime/base/file.h"
#include "runtime/base/limits.h"
#include "runtime/base/png.h"

namespace flaneur {

const char* MimeTypeOf(std::span<const uint8_t> bytes) {
  const auto starts = [&](std::initializer_list<uint8_t> magic) {
    return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
  };
  return starts({0x89, 'P', 'N', 'G'}) ? "image/png" : starts({0xff, 0xd8, 0xff}) ? "image/jpeg" : "";
}

bool ReadImageFile(const std::filesystem::path& path, Image* image) {
  if (CheckWithinRoots(path) || ReadFile(path, &image->bytes)) return false;
  image->mime_type = MimeTypeOf(image->bytes);
  if (!IsWebp(image->bytes)) return !image->mime_type.empty();
  Pixels pixels;
  if (DecodeWebpPicture(image->bytes, kFreePixels + kPixelsAByte * image->bytes.size(), &pixels)) return false;
  image->mime_type = "image/png";
  image->bytes = EncodePng(pixels.width, pixels.height, 4, pixels.rgba);
  return !image->bytes.empty();
}

}  // namespace flaneur
