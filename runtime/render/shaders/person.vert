// Everybody's pose is a row of the pose texture, three texels a joint. SHADOW: a vertex hangs on its first joint
// alone.
#include "shared.glsl"
#include "frame.glsl"
#include "haze.glsl"
#include "impostor_depth.glsl"
#include "tint_choice.glsl"

layout(location = ATTRIBUTE_POSITION) in vec3 a_position;
layout(location = ATTRIBUTE_NORMAL) in vec4 a_normal;  // and the picture's layer
layout(location = ATTRIBUTE_UV) in vec2 a_uv;
layout(location = ATTRIBUTE_COLOR) in vec4 a_color;
layout(location = ATTRIBUTE_JOINTS) in uvec4 a_joints;
layout(location = ATTRIBUTE_WEIGHTS) in vec4 a_weights;
layout(location = ATTRIBUTE_PLACE) in vec4 a_place;   // position, turn about the vertical
// Row of the pose texture, share of the pattern from, to, and 1: a prop on an impostor.
layout(location = ATTRIBUTE_LOOK) in vec4 a_look;
uniform highp sampler2D u_poses;
#ifndef SHADOW
centroid out vec3 v_position, v_normal;
out vec2 v_uv;
centroid out vec4 v_color;
out float v_haze;
flat out float v_layer;
flat out vec2 v_share;
layout(location = ATTRIBUTE_DYED) in vec4 a_dyed;
flat out vec3 v_dyed;
#endif
void main() {
  vec4 r0 = vec4(0.0), r1 = vec4(0.0), r2 = vec4(0.0);
  int row = int(a_look.x);
#ifdef SHADOW
  const int most = 1;
#else
  const int most = 4;
#endif
  for (int i = 0; i < most; ++i) {
    float w = most == 1 ? 1.0 : a_weights[i];
    if (w <= 0.0) continue;
    int j = 3 * int(a_joints[i]);
    r0 += w * texelFetch(u_poses, ivec2(j, row), 0);
    r1 += w * texelFetch(u_poses, ivec2(j + 1, row), 0);
    r2 += w * texelFetch(u_poses, ivec2(j + 2, row), 0);
  }
  vec4 p = vec4(a_position, 1.0);
  vec3 posed = vec3(dot(r0, p), dot(r1, p), dot(r2, p)) * person_size();
  float c = cos(a_place.w), s = sin(a_place.w);
  vec3 place = vec3(c * posed.x + s * posed.z, posed.y, c * posed.z - s * posed.x) + a_place.xyz;
  gl_Position = frame.view_projection * vec4(place, 1.0);
#ifndef SHADOW
  vec3 n = vec3(dot(r0.xyz, a_normal.xyz), dot(r1.xyz, a_normal.xyz), dot(r2.xyz, a_normal.xyz));
  v_position = place;
  v_haze = haze_at(place);
  v_normal = vec3(c * n.x + s * n.z, n.y, c * n.z - s * n.x);
  v_layer = floor(a_normal.w * 127.0 + 0.5);
  v_uv = a_uv;
  v_color = a_color;
  v_share = a_look.yz;
  choose_tints();
  v_dyed = a_dyed.xyz;
  if (a_look.w > 0.5) {  // a prop before the person's axis stands before the plane of their impostor
    vec2 to_eye = normalize(frame.eye.xz - a_place.xz);
    float before_m = dot(place.xz - a_place.xz, to_eye);
    float plane_m = plane_before_axis_m(place.y - a_place.y) + 0.01;
    if (before_m > -0.02) put_as_deep_as(place + vec3(to_eye.x, 0.0, to_eye.y) * (plane_m - 0.9 * before_m));
  }
#endif
}
