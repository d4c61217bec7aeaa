// A mark on the ground, in ground axes, as if it shone.
#include "shared.glsl"
#include "frame.glsl"

layout(location = ATTRIBUTE_POSITION) in vec3 a_place;
void main() { gl_Position = frame.view_projection * vec4(a_place.x, a_place.z, -a_place.y, 1.0); }
