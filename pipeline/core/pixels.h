// Decoded pictures.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/core/mesh.h"

namespace flaneur {

// 8 bits a channel, alpha straight; the upper left corner comes first.
struct Pixels {
  int width = 0, height = 0;
  std::vector<uint8_t> rgba;
};

// None where the bytes are no PNG or JPEG that can be read.
std::optional<Pixels> Decoded(const Image& image);

}  // namespace flaneur
