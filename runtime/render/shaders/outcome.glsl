// What a fragment shader leaves of a surface. DEFERRED: its colour and normal, and the light follows in a pass over the
// picture, where every pixel is lit once; small triangles shade many times their own pixels in software. NORMALS: its
// normal alone. PERSON: the surface is of a person, not of the town.
#ifndef OUTCOME_GLSL
#define OUTCOME_GLSL
#include "lighting.glsl"

#ifdef PERSON
const bool k_of_person = true;
#else
const bool k_of_person = false;
#endif

#ifdef DEFERRED
layout(location = 0) out vec4 o_color;  // as it is stored, in sRGB
layout(location = 1) out vec4 o_normal;  // and 0: of a person, 1: of the town
void leave(vec3 color, vec3 n, vec3 p, float haze) {
  o_color = vec4(color, 1.0);
  o_normal = vec4(n * 0.5 + 0.5, k_of_person ? 0.0 : 1.0);
}
#else
out vec4 o_color;
void leave(vec3 color, vec3 n, vec3 p, float haze) {
#ifdef NORMALS
  o_color = vec4(normalize(n) * 0.5 + 0.5, 1.0);
#else
  o_color = vec4(shown(lit(linear_from_srgb(color), n, p, k_of_person), haze), 1.0);
#endif
}
#endif
#endif
