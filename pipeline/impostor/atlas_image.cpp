#include "pipeline/impostor/atlas_image.h"

#include <array>
#include <cmath>

#include "runtime/base/array.h"
#include "runtime/base/srgb.h"

namespace flaneur {

double FillRate(const Pixels& albedo) {
  size_t covered = 0;
  for (size_t i = 3; i < albedo.rgba.size(); i += 4) covered += albedo.rgba[i] > 0;
  return albedo.rgba.empty() ? 0 : 4 * static_cast<double>(covered) / static_cast<double>(albedo.rgba.size());
}

Pixels Halved(const Pixels& from) {
  static const auto kLinear = [] {
    std::array<float, 256> table{};
    for (size_t i = 0; i < table.size(); ++i) table[i] = LinearFromSrgb(static_cast<float>(i) / 255);
    return table;
  }();
  Pixels to{from.width / 2, from.height / 2, {}};
  const auto at = [&](int x, int y, size_t c) {
    const uint8_t v = from.rgba[4 * RowMajor(y, from.width, x) + c];
    return c < 3 ? kLinear[v] : static_cast<float>(v) / 255;
  };
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      for (size_t c = 0; c < 4; ++c) {
        float sum = 0;
        for (int k = 0; k < 4; ++k) sum += at(2 * x + k % 2, 2 * y + k / 2, c) / 4;
        to.rgba.push_back(static_cast<uint8_t>(std::lround(255 * (c < 3 ? SrgbFromLinear(sum) : sum))));
      }
    }
  }
  return to;
}

}  // namespace flaneur
