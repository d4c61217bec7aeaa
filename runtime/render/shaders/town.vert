#include "shared.glsl"
#include "frame.glsl"
#include "haze.glsl"

layout(location = ATTRIBUTE_POSITION) in vec3 a_position;
layout(location = ATTRIBUTE_NORMAL) in vec4 a_normal;  // and the picture's layer
layout(location = ATTRIBUTE_UV) in vec2 a_uv;
layout(location = ATTRIBUTE_COLOR) in vec4 a_color;
centroid out vec3 v_position, v_normal;
out vec2 v_uv;
centroid out vec4 v_color;
out float v_haze;
flat out float v_layer;
void main() {
  v_haze = haze_at(a_position);
  v_position = a_position;
  v_normal = a_normal.xyz;
  v_layer = floor(a_normal.w * 127.0 + 0.5);
  v_uv = a_uv;
  v_color = a_color;
  gl_Position = frame.view_projection * vec4(a_position, 1.0);
}
