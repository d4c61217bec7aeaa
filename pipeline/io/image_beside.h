// Pictures that a city model names beside itself.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>

#include "pipeline/core/mesh.h"

namespace flaneur {

// By a picture's first bytes; "" where they are neither PNG nor JPEG.
const char* MimeTypeOf(std::span<const uint8_t> bytes);

// The bytes of a PNG, JPEG or WebP, told by the content; the last becomes PNG. The name stays. False where the file may
// not be read, cannot be, or is none of these.
bool ReadImageFile(const std::filesystem::path& path, Image* image);

}  // namespace flaneur
