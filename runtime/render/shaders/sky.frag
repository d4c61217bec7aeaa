#include "frame.glsl"
#include "finished.glsl"

in vec3 v_ray;
out vec4 o_color;
float hash(vec2 p) { return fract(sin(dot(p, vec2(41.3, 289.1))) * 43758.5453); }
float noise(vec2 p) {
  vec2 i = floor(p), f = fract(p);
  f = f * f * (3.0 - 2.0 * f);
  return mix(mix(hash(i), hash(i + vec2(1, 0)), f.x), mix(hash(i + vec2(0, 1)), hash(i + vec2(1, 1)), f.x), f.y);
}
void main() {
  vec3 d = normalize(v_ray);
  float up = max(d.y, 0.0);
  vec3 color = mix(frame.haze_color.rgb, frame.zenith_color.rgb, pow(up, 0.45));
  vec2 q = d.xz / (up + 0.12) * 1.4;
  float cloud = noise(q) * 0.55 + noise(q * 2.3 + 7.0) * 0.3 + noise(q * 5.1) * 0.15;
  vec3 cloud_color = 0.35 * frame.haze_color.rgb + 0.85 * frame.sky_color.rgb + 0.06 * frame.sun_color.rgb;
  color = mix(color, cloud_color, smoothstep(0.52, 0.85, cloud) * smoothstep(0.02, 0.25, d.y) * 0.65);
  // Land below the horizon, where the town has none: it lies deep enough for any town's rim to stand over it.
  float away = 10.0 / max(-d.y, 1e-4);
  vec3 land = vec3(0.12, 0.125, 0.08) * (frame.sun_color.rgb * max(frame.to_sun.y, 0.0) + frame.sky_color.rgb);
  if (d.y < 0.0) color = mix(land, frame.haze_color.rgb, 1.0 - exp(-away * 0.0014));
  float glow = max(dot(d, frame.to_sun.xyz), 0.0);
  color += frame.sun_color.rgb * (pow(glow, 500.0) * 4.0 + pow(glow, 12.0) * 0.08);
  color = (color * (2.51 * color + 0.03)) / (color * (2.43 * color + 0.59) + 0.14);
  o_color = finished(pow(clamp(color, 0.0, 1.0), vec3(1.0 / 2.2)));
}
