// Decoded pictures.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace flaneur {

// 8 bits a channel, alpha straight; the upper left corner comes first. Without rgba: a size only.
struct Pixels {
  int width = 0, height = 0;
  std::vector<uint8_t> rgba;
};

// Of a PNG's or JPEG's bytes; none where they are neither or damaged.
std::optional<Pixels> DecodedSize(std::span<const uint8_t> bytes);
std::optional<Pixels> Decoded(std::span<const uint8_t> bytes);

}  // namespace flaneur
