#include "runtime/render/block_picture.h"

#include <algorithm>
#include <array>
#include <cstring>

#define STB_DXT_IMPLEMENTATION
#define STB_DXT_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wdouble-promotion"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#include <stb/stb_dxt.h>
#pragma GCC diagnostic pop

namespace flaneur {

std::vector<uint8_t> Bc1Blocks(const PackImage& image) {
  constexpr size_t kBlockBytes = 8;
  const int across = (image.width_px + 3) / 4, up = (image.height_px + 3) / 4;
  std::vector<uint8_t> blocks(static_cast<size_t>(across) * static_cast<size_t>(up) * kBlockBytes);
  uint8_t* to = blocks.data();
  for (int y = 0; y < 4 * up; y += 4) {
    for (int x = 0; x < 4 * across; x += 4, to += kBlockBytes) {
      std::array<uint8_t, 64> texels;
      for (int i = 0; i < 16; ++i) {
        const int row = std::min(y + i / 4, image.height_px - 1), column = std::min(x + i % 4, image.width_px - 1);
        std::memcpy(&texels[static_cast<size_t>(4 * i)],
                    &image.rgba[4 * static_cast<size_t>(row * image.width_px + column)], 4);
      }
      stb_compress_dxt_block(to, texels.data(), 0, STB_DXT_NORMAL);
    }
  }
  return blocks;
}

}  // namespace flaneur
