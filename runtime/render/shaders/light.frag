#include "frame.glsl"
#include "haze.glsl"
#include "lighting.glsl"
#include "finished.glsl"

in vec4 v_near, v_far;
uniform sampler2D u_texture, u_normals;
uniform highp sampler2D u_depth;
out vec4 o_color;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec3 color = texelFetch(u_texture, at, 0).rgb;
  vec4 normal = texelFetch(u_normals, at, 0);
  vec4 p = mix(v_near, v_far, texelFetch(u_depth, at, 0).r);
  p.xyz /= p.w;
  o_color = finished(shown(lit(linear_from_srgb(color), normal.xyz * 2.0 - 1.0, p.xyz, normal.a < 0.5), haze_at(p.xyz)));
}
