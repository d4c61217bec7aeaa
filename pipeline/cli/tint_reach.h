// What tints there could be, and how much of an avatar they reach, so that whoever sets them knows before they look.
#pragma once
#include <vector>

#include "pipeline/core/avatar.h"
#include "runtime/base/error.h"
#include "runtime/pack/tint.h"

namespace flaneur {

// By tint: its share of the surface in the avatar's own pictures, materials and vertex colours, 0 to 1.
// Errors: a picture that cannot be decoded.
Error TintReach(const Avatar& avatar, const std::vector<Tint>& tints, std::vector<float>* shares);

struct MainColor {
  Vec3 color;
  float share = 0;
};  // sRGB, of the surface

// The colours that a tint could be of: up to six, the one of the largest part of the surface first, none of less than a
// thirtieth. Errors: as above.
Error MainColors(const Avatar& avatar, std::vector<MainColor>* colors);

}  // namespace flaneur
