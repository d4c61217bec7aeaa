// Of people: how far each of the avatar's tints moves its cloth's colour (runtime/pack/tint.h), and how large they are.
#ifndef TINT_CHOICE_GLSL
#define TINT_CHOICE_GLSL
#include "shared.glsl"

// By tint: 0 its own colour, k the k-th of its others; and the person's size, 0 as in the pack.
layout(location = ATTRIBUTE_TINTS) in uvec4 a_tints;
float person_size() { return a_tints.w == 0u ? 1.0 : 1.0 + (float(a_tints.w) - SIZE_MIDDLE) * SIZE_STEP; }
#ifndef SHADOW
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
