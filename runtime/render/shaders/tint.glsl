// The colour of cloth, dyed as tint_choice.glsl has chosen.
#ifndef TINT_GLSL
#define TINT_GLSL
#include "shared.glsl"

flat in vec3 v_tint0, v_tint1, v_tint2;
// Colour, with half its lightness taken off, and 1 / reach squared, below 0 of a tint that is bound to materials.
uniform vec4 u_tints[MAX_TINTS];
const vec3 k_lightness = vec3(0.30, 0.59, 0.11);
const float k_bound_shade = 0.25;
// In folds, darker than the cloth, as much less: all of the way would lead to another hue.
float in_fold(vec3 half_light, vec4 tint) {
  return min(1.0, dot(half_light, k_lightness) / max(0.02, dot(tint.rgb, k_lightness)));
}
float tint_share(vec3 half_light, vec4 tint) {
  float shade = tint.w < 0.0 ? mix(in_fold(half_light, tint), 1.0, k_bound_shade) : 1.0;
  vec3 off = half_light - shade * tint.rgb;
  return clamp(2.0 - 2.0 * dot(off, off) * abs(tint.w), 0.0, 1.0);
}
// dyed: by tint, whether it may dye this place.
vec3 tinted(vec3 color, vec3 dyed) {
  vec3 half_light = color - 0.5 * dot(color, k_lightness);
  float share0 = dyed.x * tint_share(half_light, u_tints[0]);
  float share1 = min(1.0 - share0, dyed.y * tint_share(half_light, u_tints[1]));
  float share2 = min(1.0 - share0 - share1, dyed.z * tint_share(half_light, u_tints[2]));
  color += share0 * in_fold(half_light, u_tints[0]) * v_tint0 + share1 * in_fold(half_light, u_tints[1]) * v_tint1 +
           share2 * in_fold(half_light, u_tints[2]) * v_tint2;
  return clamp(color, 0.0, 1.0);
}
#endif
