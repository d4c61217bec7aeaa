// Tints: people of one model wear their cloth in several colours. A cloth is known by its colour, and, where a
// tint is bound to materials, by these; runtime/render's shaders do the same as these functions. Colours are the
// pictures' own, sRGB, 0 to 1.
#pragma once
#include <cstddef>
#include <vector>

#include "runtime/tour_data/avatar_data.h"

namespace flaneur {

// Colours are compared as points without half of their lightness, since folds and dirt darken a cloth.
Vec3 WithHalfLightness(Vec3 color);

// How much of a colour is the tint's cloth: 1 within 0.7 of its reach from its colour, falling to 0 at its reach. Of a
// tint that is bound to materials, shadows of its colour are nearer: there no other garment or hair may have them.
float TintShare(const Tint& tint, Vec3 color);

// The colour after each tint has moved its share by the way from its own colour to another, which keeps weave and
// folds: where the colour is darker than the cloth, by as much less, or folds would be of another hue. `chosen`, by
// tint: 0 its own colour, k the k-th of its others. A share that an earlier tint has taken is not taken again.
Vec3 Tinted(const std::vector<Tint>& tints, const std::vector<size_t>& chosen, Vec3 color);

}  // namespace flaneur
