// What visitors see while a tour loads.
#pragma once
#include <cstdint>
#include <vector>

#include "runtime/base/math.h"

namespace flaneur {

inline constexpr int kMaxTitlePicture_px = 1920, kMaxTitleLogo_px = 800;  // their longer side in a pack

struct TitlePage {
  std::vector<uint8_t> picture, logo;       // files: PNG or JPEG; empty: none
  Vec3 background{0.055f, 0.047f, 0.039f};  // sRGB, 0 to 1
  bool there() const { return !picture.empty() || !logo.empty(); }
};

}  // namespace flaneur
