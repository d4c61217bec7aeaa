// Of people: how far each of the avatar's tints moves its cloth's colour (runtime/pack/tint.h), and how large and broad
// they are.
#ifndef TINT_CHOICE_GLSL
#define TINT_CHOICE_GLSL
#include "shared.glsl"

// By tint, four bits each: 0 its own colour, k the k-th of its others; then the person's breadth and size, 0 as in the
// pack.
layout(location = ATTRIBUTE_TINTS) in uvec4 a_tints;
float share_of(uint step) { return step == 0u ? 1.0 : 1.0 + (float(step) - SIZE_MIDDLE) * SIZE_STEP; }
vec3 person_size() {
  float size = share_of(a_tints.w), across = size * share_of(a_tints.z);
  return vec3(across, size, across);
}
#ifndef SHADOW
uniform vec4 u_tint_shifts[MAX_TINTS * MAX_TINT_COLORS];
flat out vec3 v_tint0, v_tint1, v_tint2;
vec3 tint_shift(uint tint, uint chosen) {
  return chosen == 0u ? vec3(0.0) : u_tint_shifts[tint * uint(MAX_TINT_COLORS) + chosen - 1u].rgb;
}
void choose_tints() {
  v_tint0 = tint_shift(0u, a_tints.x & 15u);
  v_tint1 = tint_shift(1u, a_tints.x >> 4);
  v_tint2 = tint_shift(2u, a_tints.y);
}
#endif
#endif
