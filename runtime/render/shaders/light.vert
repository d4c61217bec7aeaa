// The light of every pixel, from what DEFERRED left of it.
#include "frame.glsl"

out vec4 v_near, v_far;  // ends of the ray through a pixel, homogeneous: the depth divides it evenly
void main() {
  vec2 p = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0;
  gl_Position = vec4(p, 1.0, 1.0);  // behind everything
  v_near = frame.inverse_view_projection * vec4(p, -1.0, 1.0);
  v_far = frame.inverse_view_projection * vec4(p, 1.0, 1.0);
}
