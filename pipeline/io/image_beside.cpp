#include "pipeline/io/image_beside.h"

#include <algorithm>
#include <initializer_list>

#include "pipeline/core/child_policy.h"
#include "pipeline/io/webp_picture.h"
#include "runtime/base/file.h"
#include "runtime/base/limits.h"
#include "runtime/base/png.h"

namespace flaneur {

bool ReadImageFile(const std::filesystem::path& path, Image* image) {
  if (CheckWithinRoots(path) || ReadFile(path, &image->bytes)) return false;
  const auto starts = [&](std::initializer_list<uint8_t> magic) {
    return image->bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), image->bytes.begin());
  };
  image->mime_type = starts({0x89, 'P', 'N', 'G'}) ? "image/png" : starts({0xff, 0xd8, 0xff}) ? "image/jpeg" : "";
  if (!IsWebp(image->bytes)) return !image->mime_type.empty();
  Pixels pixels;
  if (DecodeWebpPicture(image->bytes, kFreePixels + kPixelsAByte * image->bytes.size(), &pixels)) return false;
  image->mime_type = "image/png";
  image->bytes = EncodePng(pixels.width, pixels.height, 4, pixels.rgba);
  return !image->bytes.empty();
}

}  // namespace flaneur
