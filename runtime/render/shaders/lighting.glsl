// Light: sun with shadow maps (town near and far, people), sky and ground from all sides, haze. ONE_SHADOW_TAP: shadows
// are looked up once, not four times.
#ifndef LIGHTING_GLSL
#define LIGHTING_GLSL
#include "frame.glsl"

uniform sampler2DArrayShadow u_town_shadow_map;
uniform sampler2DShadow u_people_shadow_map;
const vec2 k_taps[4] = vec2[4](vec2(-0.5, -0.5), vec2(0.5, -0.5), vec2(-0.5, 0.5), vec2(0.5, 0.5));
float town_shadow(vec3 p) {
  vec3 near = (frame.near_shadow * vec4(p, 1.0)).xyz * 0.5 + 0.5;
  vec3 far = (frame.far_shadow * vec4(p, 1.0)).xyz * 0.5 + 0.5;
  vec3 off = abs(near - 0.5);
  bool in_near = max(off.x, max(off.y, off.z)) < 0.497;
  vec4 c = in_near ? vec4(near.xy, frame.shadow_layers.x, near.z - 0.0006)
                   : vec4(far.xy, frame.shadow_layers.y, far.z - 0.0012);
  vec3 beyond = abs(c.xyw - 0.5);
  if (max(beyond.x, max(beyond.y, beyond.z)) > 0.499) return 1.0;
#ifdef ONE_SHADOW_TAP
  return texture(u_town_shadow_map, c);
#else
  vec2 texel = 1.0 / vec2(textureSize(u_town_shadow_map, 0).xy);
  float sum = 0.0;
  for (int i = 0; i < 4; ++i) sum += texture(u_town_shadow_map, vec4(c.xy + k_taps[i] * texel, c.zw));
  return sum * 0.25;
#endif
}
// Fades out towards the map's rim and the end of its reach, so that nobody's shadow vanishes at once.
float people_shadow(vec3 p) {
  vec3 c = (frame.people_shadow * vec4(p, 1.0)).xyz * 0.5 + 0.5;
  vec3 off = abs(c - 0.5);
  float rim = max(off.x, max(off.y, off.z));
  if (rim > 0.499) return 1.0;
#ifdef ONE_SHADOW_TAP
  float sum = texture(u_people_shadow_map, vec3(c.xy, c.z - 0.0012));
#else
  vec2 texel = 1.0 / vec2(textureSize(u_people_shadow_map, 0));
  float sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    sum += 0.25 * texture(u_people_shadow_map, vec3(c.xy + k_taps[i] * texel, c.z - 0.0012));
  }
#endif
  float reach = distance(p, frame.eye.xyz) / frame.shadow_layers.z;
  return mix(sum, 1.0, max(smoothstep(0.42, 0.49, rim), smoothstep(0.8, 1.0, reach)));
}
vec3 lit(vec3 albedo, vec3 towards, vec3 p) {
  vec3 n = normalize(towards);
  float sun = max(dot(n, frame.to_sun.xyz), 0.0);
  vec3 lifted = p + n * 0.05;
  if (sun > 0.0) sun *= town_shadow(lifted) * people_shadow(lifted);
  vec3 around = mix(frame.ground_color.rgb, frame.sky_color.rgb, n.y * 0.5 + 0.5);
  return albedo * (frame.sun_color.rgb * sun + around);
}
vec3 shown(vec3 color, float haze) {
  // Filmic tone curve (Narkowicz's fit of ACES) and the display's 1 / 2.2 in one, fitted on [0, 5], off by at most
  // 0.006.
  vec3 s = sqrt(mix(color, frame.haze_color.rgb, haze));
  return s * (0.3955 + 3.7304 * s) / (1.0 + s * (3.9385 * s - 0.4040));
}
// Colour pictures are filtered as they are stored, in sRGB, which software does several times faster, and made linear
// here: a cubic through the curve, off by less than 0.003.
vec3 linear_from_srgb(vec3 c) { return c * (c * (c * 0.305306 + 0.682171) + 0.012523); }
#endif
