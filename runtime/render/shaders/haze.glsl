// How much of the colour at p the air on the way to the eye replaces: little enough to be mixed between the
// corners of a triangle.
#ifndef HAZE_GLSL
#define HAZE_GLSL
#include "frame.glsl"

float haze_at(vec3 p) { return 1.0 - exp(-distance(p, frame.eye.xyz) * 0.0014); }
#endif
