// What Draco's data says of its size, read without decoding: the decoder allocates for it.
#pragma once
#include <cstdint>
#include <optional>
#include <span>

namespace flaneur {

struct DracoSize {
  uint64_t vertices = 0, faces = 0;
};

// Of a mesh without metadata, in all versions of the bitstream up to 2.2; none where the bytes are something else.
std::optional<DracoSize> DracoSizeOf(std::span<const uint8_t> bytes);

}  // namespace flaneur
