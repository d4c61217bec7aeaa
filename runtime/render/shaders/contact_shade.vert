// A soft spot on the ground about somebody's feet, as everything near keeps the sky from it. It leans as the ground does
// and lies a little before it.
#include "shared.glsl"
#include "frame.glsl"

layout(location = ATTRIBUTE_POSITION) in vec2 a_corner;  // 0 to 1
layout(location = ATTRIBUTE_PLACE) in vec4 a_place;      // position, turn about the vertical
layout(location = ATTRIBUTE_LOOK) in vec4 a_look;        // the ground's rise a metre along x and z, radius, strength
out vec2 v_at;
flat out float v_strength;
const float k_before_m = 0.06, k_above_m = 0.012;
void main() {
  v_at = a_corner * 2.0 - 1.0;
  v_strength = a_look.w;
  vec2 flat_m = v_at * a_look.z * vec2(1.0, 1.2);
  float c = cos(a_place.w), s = sin(a_place.w);
  vec2 offset = vec2(c * flat_m.x + s * flat_m.y, c * flat_m.y - s * flat_m.x);
  vec3 p = a_place.xyz + vec3(offset.x, dot(offset, a_look.xy) + k_above_m, offset.y);
  gl_Position = frame.view_projection * vec4(p + normalize(frame.eye.xyz - p) * k_before_m, 1.0);
}
