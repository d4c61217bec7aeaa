// Pictures of glTF's KHR_texture_basisu: KTX2 files in Basis Universal, which graphics cards would transcode.
#pragma once
#include <cstdint>
#include <span>

#include "runtime/base/error.h"
#include "runtime/base/pixels.h"

namespace flaneur {

bool IsKtx2(std::span<const uint8_t> bytes);

// The finest level; ETC1S, or UASTC plain or in Zstandard. Takes at most `most_pixels`. Nothing is trusted.
// Errors: another code, no flat picture, truncated, damaged, larger than it may be.
Error DecodeBasisPicture(std::span<const uint8_t> bytes, uint64_t most_pixels, Pixels* pixels);

}  // namespace flaneur
