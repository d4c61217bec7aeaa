#include "pipeline/io/webp_picture.h"

#include <webp/decode.h>

#include <algorithm>
#include <string>
#include <string_view>

namespace flaneur {

bool IsWebp(std::span<const uint8_t> bytes) {
  const auto says = [&](size_t at, std::string_view text) { return std::equal(text.begin(), text.end(), &bytes[at]); };
  return bytes.size() >= 12 && says(0, "RIFF") && says(8, "WEBP");
}

Error DecodeWebpPicture(std::span<const uint8_t> bytes, uint64_t most_pixels, Pixels* pixels) {
  int width = 0, height = 0;
  if (WebPGetInfo(bytes.data(), bytes.size(), &width, &height) == 0 || width <= 0 || height <= 0)
    return Fail("is a damaged WebP picture; export it again");
  const auto count = static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
  if (count > most_pixels)
    return Fail("is a WebP picture of " + std::to_string(width) + " x " + std::to_string(height) +
                " pixels, more than its bytes can hold; make it smaller");
  pixels->width = width;
  pixels->height = height;
  pixels->rgba.resize(4 * count);
  if (WebPDecodeRGBAInto(bytes.data(), bytes.size(), pixels->rgba.data(), pixels->rgba.size(), 4 * width) == nullptr)
    return Fail("is a damaged WebP picture; export it again");
  return Ok();
}

}  // namespace flaneur
