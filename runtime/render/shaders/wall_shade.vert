// A strip on the ground at the foot of a wall. It lies a little before the ground.
#include "shared.glsl"
#include "frame.glsl"

layout(location = ATTRIBUTE_POSITION) in vec4 a_position;  // and how far out
uniform float u_share;  // of the light, that a wall keeps
out float v_out;
out float v_strength;
const float k_before_m = 0.05, k_above_m = 0.01, k_fades_m = 45.0, k_ends_m = 70.0;
void main() {
  vec3 p = a_position.xyz + vec3(0.0, k_above_m, 0.0);
  vec3 to_eye = frame.eye.xyz - p;
  v_out = a_position.w;
  v_strength = u_share * (1.0 - smoothstep(k_fades_m, k_ends_m, length(to_eye)));
  gl_Position = frame.view_projection * vec4(p + normalize(to_eye) * k_before_m, 1.0);
}
