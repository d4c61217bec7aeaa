#include "frame.glsl"

out vec3 v_ray;
void main() {
  vec2 p = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0;
  gl_Position = vec4(p, 1.0, 1.0);
  vec4 a = frame.inverse_view_projection * vec4(p, 1.0, 1.0), b = frame.inverse_view_projection * vec4(p, -1.0, 1.0);
  v_ray = a.xyz / a.w - b.xyz / b.w;
}
