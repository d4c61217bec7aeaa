// ETC1S in BasisLZ, the smaller code of Basis Universal: two books of colours and of patterns for all pictures of a
// file, and for each block of 4 x 4 texels a place in both, by Huffman codes. After the appendix "BasisLZ/ETC1S
// Bitstream Specification" of the Khronos KTX 2.0 specification.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/base/error.h"

namespace flaneur {

struct HuffmanTable {
  std::array<uint32_t, 17> count_of_length{};
  std::vector<uint16_t> symbols;  // by length, then by number
};

struct Etc1sColor {
  std::array<uint8_t, 3> rgb{};  // of 31
  uint8_t contrast = 0;          // row of ETC1's table of intensities
};

// What all pictures of a file share. Nothing of it is trusted.
struct Etc1sBooks {
  std::vector<Etc1sColor> colors;
  std::vector<std::array<uint8_t, 4>> patterns;  // a byte a row, two bits a texel, the left one lowest
  HuffmanTable prediction, color_step, pattern, run;
  uint32_t history = 0;  // patterns that are remembered
};

// Errors: a book that ends early or is no sound code.
Error ReadEtc1sBooks(size_t colors, std::span<const uint8_t> color_bytes, size_t patterns,
                     std::span<const uint8_t> pattern_bytes, std::span<const uint8_t> table_bytes, Etc1sBooks* books);

// RGB of all blocks: 12 blocks_x bytes a row, 4 blocks_y rows. Errors: a slice that ends early or names what is none.
Error DecodeEtc1sSlice(const Etc1sBooks& books, std::span<const uint8_t> bytes, int blocks_x, int blocks_y,
                       std::vector<uint8_t>* rgb);

}  // namespace flaneur
