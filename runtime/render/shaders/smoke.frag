#include "lighting.glsl"

in vec2 v_at;
flat in vec2 v_look;
flat in vec4 v_light;
out vec4 o_color;
void main() {
  // Waves bend the spot, so that no two are round alike.
  vec2 at = v_at + 0.16 * sin(v_at.yx * 4.7 + v_look.y * vec2(3.0, 5.0)) * (1.0 - dot(v_at, v_at) * 0.5);
  float near = max(0.0, 1.0 - dot(at, at)) * clamp(3.0 - 3.0 * dot(v_at, v_at), 0.0, 1.0);
  o_color = vec4(shown(v_light.rgb, v_light.a), v_look.x * near);
}
