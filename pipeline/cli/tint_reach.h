// What tints there could be, and how much of an avatar they reach, so that whoever sets them knows before they look.
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"
#include "runtime/base/error.h"
#include "runtime/pack/tint.h"

namespace flaneur {

// By tint: its share of the surface in the avatar's own pictures, materials and vertex colours, 0 to 1.
// Errors: a picture that cannot be decoded.
Error TintReach(const Avatar& avatar, const std::vector<Tint>& tints, std::vector<float>* shares);

// Notes in each material which tints may dye it. `names`: by tint the materials that it is bound to; empty: all.
// Errors: a name that no material of the avatar has (says which there are).
Error BindTints(const std::vector<std::vector<std::string>>& names, Avatar* avatar);

struct MainColor {
  Vec3 color;
  float share = 0;
};  // sRGB, of the surface

// The colours that a tint could be of: up to six, the one of the largest part of the surface first, none of less than a
// thirtieth. Errors: as above.
Error MainColors(const Avatar& avatar, std::vector<MainColor>* colors);

}  // namespace flaneur
