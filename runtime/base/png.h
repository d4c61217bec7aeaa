// Still images.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "runtime/base/error.h"

namespace flaneur {

// 8 bits a channel, top row first; empty where there is not enough memory.
std::vector<uint8_t> EncodePng(int width_px, int height_px, int channels, const std::vector<uint8_t>& pixels);

// RGB, top row first; quality: 1 to 100. Empty where there is not enough memory.
std::vector<uint8_t> EncodeJpeg(int width_px, int height_px, int quality, const std::vector<uint8_t>& rgb);

// RGB, 8 bits a channel, top row first. Errors: as for WriteFile.
Error WritePng(const std::filesystem::path& path, int width_px, int height_px, const std::vector<uint8_t>& rgb);

}  // namespace flaneur
