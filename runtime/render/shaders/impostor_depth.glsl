// How deep an impostor is: as a plane that stands before the feet, so that the ground leaves them, and leans back to the
// head, so that a counter or a wall before the person hides them. Were each pixel as deep as what it shows, neither
// graphics cards nor software could test its depth before the shader: whoever is hidden would cost as much as the seen.
#ifndef IMPOSTOR_DEPTH_GLSL
#define IMPOSTOR_DEPTH_GLSL
#include "frame.glsl"

// How far the plane is before the person's axis.
float plane_before_axis_m(float height_m) { return 0.35 - 0.14 * height_m; }
// Leaves a corner where it is in the picture, as deep as p.
void put_as_deep_as(vec3 p) {
  vec4 clip = frame.view_projection * vec4(p, 1.0);
  gl_Position.z = clip.z / max(clip.w, 0.05) * gl_Position.w;
}
#endif
