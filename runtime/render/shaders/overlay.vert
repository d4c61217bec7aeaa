// Dear ImGui's triangles: places in pixels from the upper left corner, colours as they are shown.
#include "shared.glsl"

layout(location = ATTRIBUTE_POSITION) in vec2 a_place;
layout(location = ATTRIBUTE_UV) in vec2 a_uv;
layout(location = ATTRIBUTE_COLOR) in vec4 a_color;
uniform vec3 u_size;
out vec2 v_uv;
out vec4 v_color;
void main() {
  v_uv = a_uv;
  v_color = a_color;
  gl_Position = vec4(a_place.x / u_size.x * 2.0 - 1.0, 1.0 - a_place.y / u_size.y * 2.0, 0.0, 1.0);
}
