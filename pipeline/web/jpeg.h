// Internal to pipeline/web.
#pragma once
#include <cstdint>
#include <vector>

#include "runtime/base/pixels.h"

namespace flaneur {

// quality: 1 to 100. Without alpha. Empty where there is not enough memory.
std::vector<uint8_t> EncodeJpeg(const Pixels& pixels, int quality);

}  // namespace flaneur
