// Pictures that a city model names beside itself.
#pragma once
#include <filesystem>

#include "pipeline/core/mesh.h"

namespace flaneur {

// PNG, JPEG or WebP, told by the content; the last becomes PNG. False where the file may not be read, cannot be, or is
// none of these.
bool ReadImageFile(const std::filesystem::path& path, Image* image);

// Of one component of a colour as text files have it, for screens.
float LinearFromSrgb(float srgb);

}  // namespace flaneur
