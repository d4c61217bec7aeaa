// Bits of a stream, the least of a byte first.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace flaneur {

struct BitReader {
  std::span<const uint8_t> bytes;
  size_t at = 0;       // bit
  bool ended = false;  // something was asked for beyond the end; it was 0

  uint32_t Take(int count) {
    uint32_t value = 0;
    for (int i = 0; i < count; ++i, ++at) {
      if (at / 8 >= bytes.size()) {
        ended = true;
        return 0;
      }
      value |= (uint32_t{bytes[at / 8]} >> at % 8 & 1u) << i;
    }
    return value;
  }
};

}  // namespace flaneur
