// Of people: how far each of the avatar's tints moves its cloth's colour (runtime/pack/tint.h).
#ifndef TINT_CHOICE_GLSL
#define TINT_CHOICE_GLSL
#include "shared.glsl"

#ifndef SHADOW
layout(location = ATTRIBUTE_TINTS) in uvec4 a_tints;  // by tint: 0 its own colour, k the k-th of its others
uniform vec4 u_tint_shifts[MAX_TINTS * MAX_TINT_COLORS];
flat out vec3 v_tint0, v_tint1, v_tint2;
vec3 tint_shift(uint tint, uint chosen) {
  return chosen == 0u ? vec3(0.0) : u_tint_shifts[tint * uint(MAX_TINT_COLORS) + chosen - 1u].rgb;
}
void choose_tints() {
  v_tint0 = tint_shift(0u, a_tints.x);
  v_tint1 = tint_shift(1u, a_tints.y);
  v_tint2 = tint_shift(2u, a_tints.z);
}
#endif
#endif
