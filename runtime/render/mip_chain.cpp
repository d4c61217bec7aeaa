#include "runtime/render/mip_chain.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/base/srgb.h"

namespace flaneur {
namespace {

constexpr int kLinearSteps = 4096;

struct SrgbTables {
  std::array<uint16_t, 256> to_linear;  // 0 to kLinearSteps - 1
  std::array<uint8_t, kLinearSteps> from_linear;
  SrgbTables() {
    for (size_t i = 0; i < to_linear.size(); ++i) {
      const double c = static_cast<double>(i) / 255;
      to_linear[i] = static_cast<uint16_t>(LinearFromSrgb(c) * (kLinearSteps - 1) + 0.5);
    }
    for (size_t i = 0; i < from_linear.size(); ++i) {
      const double l = static_cast<double>(i) / (kLinearSteps - 1);
      from_linear[i] = static_cast<uint8_t>(SrgbFromLinear(l) * 255 + 0.5);
    }
  }
};

PackImage Half(const PackImage& from, bool srgb) {
  static const SrgbTables tables;
  PackImage to{std::max(1, from.width_px / 2), std::max(1, from.height_px / 2), {}};
  to.rgba.resize(static_cast<size_t>(to.width_px) * static_cast<size_t>(to.height_px) * 4);
  const int right = from.width_px > 1 ? 4 : 0;
  const size_t row_bytes = static_cast<size_t>(from.width_px) * 4;
  uint8_t* out = to.rgba.data();
  for (int y = 0; y < to.height_px; ++y) {
    const uint8_t* upper = &from.rgba[static_cast<size_t>(2 * y) * row_bytes];
    const uint8_t* lower = from.height_px > 1 ? upper + row_bytes : upper;
    for (int x = 0; x < to.width_px; ++x, upper += 8, lower += 8, out += 4) {
      for (int c = 0; c < 4; ++c) {
        const uint8_t four[] = {upper[c], upper[right + c], lower[c], lower[right + c]};
        if (srgb && c < 3) {
          int sum = 2;
          for (uint8_t v : four) sum += tables.to_linear[v];
          out[c] = tables.from_linear[static_cast<size_t>(sum / 4)];
        } else {
          out[c] = static_cast<uint8_t>((four[0] + four[1] + four[2] + four[3] + 2) / 4);
        }
      }
    }
  }
  return to;
}

}  // namespace

std::vector<PackImage> MakeMipChain(const PackImage& image, bool srgb, int most_level) {
  std::vector<PackImage> levels;
  const PackImage* last = &image;
  while (static_cast<int>(levels.size()) < most_level && (last->width_px > 1 || last->height_px > 1)) {
    levels.push_back(Half(*last, srgb));
    last = &levels.back();
  }
  return levels;
}

}  // namespace flaneur
