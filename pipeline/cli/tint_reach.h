// How much of an avatar a tint reaches, so that whoever sets it knows before they look.
#pragma once
#include <vector>

#include "pipeline/core/avatar.h"
#include "runtime/base/error.h"
#include "runtime/pack/tint.h"

namespace flaneur {

// By tint: its share of the surface in the avatar's own pictures, materials and vertex colours, 0 to 1.
// Errors: a picture that cannot be decoded.
Error TintReach(const Avatar& avatar, const std::vector<PackTint>& tints, std::vector<float>* shares);

}  // namespace flaneur
