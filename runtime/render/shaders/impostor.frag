#include "frame.glsl"
#include "impostor_views.glsl"
#include "outcome.glsl"
#include "tint.glsl"
#include "fade.glsl"

uniform sampler2D u_normals, u_tint_picture;
uniform float u_tint_regions;  // 0: there is no picture of where tints may dye
const float k_hides = 0.999;  // not all: straight from a picture's direction it alone has a share
vec3 normal_at(View view, vec2 at) {
  vec2 square = textureLod(u_normals, at, v_normals_level).rg * 2.0 - 1.0;
  vec2 p = vec2(square.x + square.y, square.x - square.y) * 0.5;
  float near = 1.0 - abs(p.x) - abs(p.y), out_m = v_look.w * near - v_look.z * p.y;
  float up_m = v_look.w * p.y + v_look.z * near;
  return vec3(view.turn.x * p.x + view.turn.y * out_m, up_m, view.turn.x * out_m - view.turn.y * p.x);
}
void main() {
  vec2 across = dFdx(v_texel), texel = vec2(1.0, -1.0) / u_atlas.zw;
  mat2 pixel = mat2(across * texel, dFdy(v_texel) * texel);
  View view = View(v_point0, v_ray0, v_cell0, v_origins.xy, v_turns.xy, v_look.x);
  View other = View(v_point1, v_ray1, v_cell1, v_origins.zw, v_turns.zw, v_look.x);
  COVER cover = COVER(0.0);
  vec3 color = vec3(0.0), n = vec3(0.0);
  vec2 seen_at = vec2(0.0);  // where the picture that counts most shows it
  float most = 0.0, along = 0.0, weight = 0.0, covered_before = 0.0, parts_before = 0.0, phase_part = 1.0;
  int pictures = v_pictures.x;
#ifndef FAST
  float beside_part = part_beside();
  phase_part -= beside_part;
  if (beside_part > 0.0) pictures *= 2;
#endif
  // A loop of as many turns as there are pictures, for it is what software can leave early.
  for (int k = 0; k < pictures; ++k) {
#ifndef FAST
    if (k == 2) {
      view = beside(view, v_pictures.y);
      other = beside(other, v_pictures.z);
      phase_part = beside_part;
    }
#endif
    float direction_part = (k & 1) == 0 ? 1.0 - v_look.y : v_look.y, part = direction_part * phase_part;
    Meeting m = meet(view, other, 1.0 - direction_part, pixel);
    float own_cover = m.trust * mean_of(m.cover), own = part * own_cover;
    // Where only one of them shows the person, it alone counts; and where one sees what is hidden from the others, too.
    if (min(own_cover, covered_before) > 0.5) {
      float apart = (along / weight - m.along) * length(v_ray), hides = k_hides * min(1.0, k_counts * part);
      float others = 1.0 - hides * smoothstep(0.04, 0.10, apart);
      color *= others, n *= others, along *= others, weight *= others;
      own *= 1.0 - k_hides * min(1.0, k_counts * parts_before) * smoothstep(0.04, 0.10, -apart);
    }
#ifdef FAST
    cover += part * m.cover;
#else
    cover = max(cover, min(1.0, k_counts * direction_part) * min(1.0, k_phase_counts * phase_part) * m.cover);
#endif
    if (own > most) {
      most = own;
      seen_at = m.at;
    }
    color += own * m.color;
    n += own * normal_at(view, m.at);
    along += own * m.along;
    weight += own;
    covered_before = max(covered_before, own_cover);
    parts_before += part;
    View swapped = view;
    view = other;
    other = swapped;
  }
  float coverage = 1.0;
#ifdef SMOOTH_EDGES
  // A sample is covered as a geometry's edge covers it, fully or not; what is thinner than a texel covers some of them.
  // As many samples are written, by an alpha that drivers which round it and those which round it up take for the same
  // number.
  vec4 covered = clamp((cover - 0.5) * 2.0 * max(1.0, inversesqrt(max(dot(across, across), 0.01))) + 0.5, 0.0, 1.0);
  coverage = (floor(dot(covered, vec4(1.0)) + 0.5) - 0.3) * 0.25;
  if (coverage <= 0.0) discard;
#else
  if (cover < 0.5) discard;
#endif
  keep_share();
  float whole = 1.0 / max(weight, 1e-4);
  vec3 p = frame.eye.xyz + v_ray * (1.0 + along * whole);
#ifndef FAST
  vec4 clip = frame.view_projection * vec4(p, 1.0);
  gl_FragDepth = clip.z / clip.w * 0.5 + 0.5;
#endif
  vec3 dyed = vec3(1.0);
  if (u_tint_regions > 0.0) dyed = textureLod(u_tint_picture, seen_at, max(v_level - 1.0, 0.0)).rgb;
  leave(tinted(color * whole, dyed), normalize(n), p, v_haze);
  o_color.a = coverage;
}
