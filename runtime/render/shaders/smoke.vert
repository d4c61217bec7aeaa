// A puff of smoke that turns to the eye, lit alike all over.
#include "shared.glsl"
#include "frame.glsl"
#include "haze.glsl"

layout(location = ATTRIBUTE_POSITION) in vec2 a_corner;  // 0 to 1
layout(location = ATTRIBUTE_PLACE) in vec4 a_place;      // in ground axes; radius
layout(location = ATTRIBUTE_LOOK) in vec2 a_look;        // density, turn
out vec2 v_at;
flat out vec2 v_look;
flat out vec4 v_light;  // and the haze
const vec3 k_albedo = vec3(0.62, 0.63, 0.65);  // brighter than the sky, as wood smoke in the sun is
void main() {
  v_at = a_corner * 2.0 - 1.0;
  v_look = a_look;
  vec3 p = vec3(a_place.x, a_place.z, -a_place.y), ahead = normalize(p - frame.eye.xyz);
  vec3 right = normalize(cross(ahead, vec3(0.0, 1.0, 0.001))), up = cross(right, ahead);
  float c = cos(a_look.y), s = sin(a_look.y);
  vec2 turned = vec2(c * v_at.x - s * v_at.y, s * v_at.x + c * v_at.y) * a_place.w;
  vec3 around = mix(frame.ground_color.rgb, frame.sky_color.rgb, 0.8);
  v_light = vec4(k_albedo * (frame.sun_color.rgb * 0.35 + around), haze_at(p));
  gl_Position = frame.view_projection * vec4(p + right * turned.x + up * turned.y, 1.0);
}
