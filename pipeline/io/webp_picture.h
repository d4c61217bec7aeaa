// Pictures of glTF's EXT_texture_webp.
#pragma once
#include <cstdint>
#include <span>

#include "runtime/base/error.h"
#include "runtime/base/pixels.h"

namespace flaneur {

bool IsWebp(std::span<const uint8_t> bytes);

// Of several the first. Takes at most `most_pixels`. Errors: no picture, larger than it may be.
Error DecodeWebpPicture(std::span<const uint8_t> bytes, uint64_t most_pixels, Pixels* pixels);

}  // namespace flaneur
