// What a JPEG's reader trusts. Internal to runtime/base.
#pragma once
#include <cstdint>
#include <span>

namespace flaneur {

// False where a Huffman table up to the picture's end has more than its 256 values or is cut: stb_image reads such
// tables beyond its own (up to 2.28, as Debian 12 has it). True of whatever is no JPEG.
bool HasSoundHuffmanTables(std::span<const uint8_t> bytes);

}  // namespace flaneur
