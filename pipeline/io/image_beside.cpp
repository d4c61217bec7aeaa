#include "pipeline/io/image_beside.h"

#include <cmath>
#include <string>

#include "pipeline/core/child_policy.h"
#include "pipeline/io/webp_picture.h"
#include "runtime/base/file.h"
#include "runtime/base/limits.h"
#include "runtime/base/png.h"

namespace flaneur {

bool ReadImageFile(const std::filesystem::path& path, Image* image) {
  std::string bytes;
  if (CheckWithinRoots(path) || ReadTextFile(path, &bytes)) return false;
  image->name = path.filename().string();
  image->bytes.assign(bytes.begin(), bytes.end());
  if (bytes.starts_with("\x89PNG")) image->mime_type = "image/png";
  if (bytes.starts_with("\xFF\xD8\xFF")) image->mime_type = "image/jpeg";
  if (!IsWebp(image->bytes)) return !image->mime_type.empty();
  Pixels pixels;
  if (DecodeWebpPicture(image->bytes, kFreePixels + kPixelsAByte * bytes.size(), &pixels)) return false;
  image->mime_type = "image/png";
  image->bytes = EncodePng(pixels.width, pixels.height, 4, pixels.rgba);
  return !image->bytes.empty();
}

float LinearFromSrgb(float srgb) { return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f); }

}  // namespace flaneur
