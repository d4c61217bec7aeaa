// Light: sun with shadow maps (town near, middle and far, people near and far), sky and ground from all sides, haze.
// ONE_SHADOW_TAP: shadows are looked up once, not four times. A surface is of the town or of a person: the town knows
// itself in its maps and people are not in them; people know figures of themselves that are coarser than they are.
#ifndef LIGHTING_GLSL
#define LIGHTING_GLSL
#include "frame.glsl"

uniform sampler2DArrayShadow u_town_shadow_map, u_people_shadow_map;
#ifdef ONE_SHADOW_TAP
float shadow_tap(sampler2DArrayShadow map, vec4 c) { return texture(map, c); }
const float k_tap_reach = 1.5;  // texels that a look-up takes in to each side, along the diagonal
#else
const vec2 k_taps[4] = vec2[4](vec2(-0.5, -0.5), vec2(0.5, -0.5), vec2(-0.5, 0.5), vec2(0.5, 0.5));
float shadow_tap(sampler2DArrayShadow map, vec4 c) {
  vec2 texel = 1.0 / vec2(textureSize(map, 0).xy);
  float sum = 0.0;
  for (int i = 0; i < 4; ++i) sum += texture(map, vec4(c.xy + k_taps[i] * texel, c.zw));
  return sum * 0.25;
}
const float k_tap_reach = 2.2;
#endif
const float k_town_bias = 0.3;       // towards the sun, in texels of the map: for its 16 bits and rounded normals
const float k_most_slope = 6.0;      // of a surface before the sun, that a bias follows
const float k_figure_bias_m = 0.34;  // a person's figure lies no farther before their skin and cloth
vec3 in_map(mat4 map, vec3 p) { return (map * vec4(p, 1.0)).xyz * 0.5 + 0.5; }
float from_middle(vec3 c) {
  vec3 off = abs(c - 0.5);
  return max(off.x, max(off.y, off.z));
}
// A surface lies clear of itself in the map once it is lifted along its normal by as far as a look-up takes texels in,
// the more the flatter the sun. Unlike a bias towards the sun that leaves no gap at the foot of what stands upright.
float town_shadow(vec3 p, vec3 n, float sine) {
  vec3 lift = n * (k_tap_reach * sine) + frame.to_sun.xyz * k_town_bias;
  vec3 near = in_map(frame.near_shadow, p + lift * frame.town_shadow_texels.x);
  vec3 middle = in_map(frame.middle_shadow, p + lift * frame.town_shadow_texels.y);
  vec3 far = in_map(frame.far_shadow, p + lift * frame.town_shadow_texels.z);
  vec4 c = from_middle(near) < 0.497     ? vec4(near.xy, frame.town_shadow_layers.x, near.z)
           : from_middle(middle) < 0.497 ? vec4(middle.xy, frame.town_shadow_layers.y, middle.z)
                                         : vec4(far.xy, frame.town_shadow_layers.z, far.z);
  return from_middle(c.xyw) > 0.499 ? 1.0 : shadow_tap(u_town_shadow_map, c);
}
// The town is not in people's maps: a bias away from the sun, by what half a texel of the map may be deep in the
// surface, makes shadows begin where feet stand. They fade out towards the coarse map's rim and the end of its reach,
// so that nobody's shadow vanishes at once.
float people_shadow(vec3 p, vec3 n, float n_to_sun, float sine, bool of_person) {
  vec3 into = frame.to_sun.xyz * (-0.5 * min(sine / n_to_sun, k_most_slope));
  vec3 clear = n * 0.05 + frame.to_sun.xyz * k_figure_bias_m;
  vec3 fine = in_map(frame.fine_shadow, p + (of_person ? clear : into * frame.people_shadows.x));
  vec3 far = in_map(frame.people_shadow, p + (of_person ? clear : into * frame.people_shadows.y));
  float rim = from_middle(far), reach = distance(p, frame.eye.xyz) / frame.people_shadows.z;
  vec4 c = max(abs(fine.x - 0.5), abs(fine.y - 0.5)) < 0.499 ? vec4(fine.xy, 0.0, fine.z) : vec4(far.xy, 1.0, far.z);
  return mix(shadow_tap(u_people_shadow_map, c), 1.0, max(smoothstep(0.42, 0.49, rim), smoothstep(0.8, 1.0, reach)));
}
vec3 lit(vec3 albedo, vec3 towards, vec3 p, bool of_person) {
  vec3 n = normalize(towards);
  float n_to_sun = dot(n, frame.to_sun.xyz), sun = max(n_to_sun, 0.0);
  if (sun > 0.0) {
    float sine = sqrt(max(0.0, 1.0 - n_to_sun * n_to_sun));
    sun *= town_shadow(p, n, sine) * people_shadow(p, n, n_to_sun, sine, of_person);
  }
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
