// Pictures that tour.toml names, in the sizes and formats of a pack. Internal to pipeline/cli.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "runtime/base/error.h"

namespace flaneur {

// Upright, no side longer than most_px; as JPEG, or as PNG where it is translucent. Errors: a file that is no picture;
// names it.
Error ScaledPicture(const std::filesystem::path& file, int most_px, std::vector<uint8_t>* bytes);

}  // namespace flaneur
