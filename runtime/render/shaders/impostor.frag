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
// What the pictures show together.
struct Seen {
  vec3 color, n;  // as often as weight says
  float along, weight;
  COVER cover;
  vec2 at;     // where the picture that counts most shows it
  float most;  // how much that counts
  float covered_before, parts_before;
};
// phase_part: of direction_part, of the phase of this picture.
void see(Meeting m, View view, float direction_part, float phase_part, inout Seen s) {
  float part = direction_part * phase_part, own_cover = m.trust * mean_of(m.cover), own = part * own_cover;
  // Where only one of them shows the person, it alone counts; and where one sees what is hidden from the others, too.
  if (min(own_cover, s.covered_before) > 0.5) {
    float apart = (s.along / s.weight - m.along) * length(v_ray), hides = k_hides * min(1.0, k_counts * part);
    float others = 1.0 - hides * smoothstep(0.04, 0.10, apart);
    s.color *= others, s.n *= others, s.along *= others, s.weight *= others;
    own *= 1.0 - k_hides * min(1.0, k_counts * s.parts_before) * smoothstep(0.04, 0.10, -apart);
  }
#ifdef FAST
  s.cover += part * m.cover;
#else
  s.cover = max(s.cover, min(1.0, k_counts * direction_part) * min(1.0, k_phase_counts * phase_part) * m.cover);
#endif
  if (own > s.most) {
    s.most = own;
    s.at = m.at;
  }
  s.color += own * m.color;
  s.n += own * normal_at(view, m.at);
  s.along += own * m.along;
  s.weight += own;
  s.covered_before = max(s.covered_before, own_cover);
  s.parts_before += part;
}
void main() {
  vec2 across = dFdx(v_texel);
  View view = View(v_point0, v_ray0, v_cell0, v_origins.xy, v_turns.xy, v_look.x);
  View other = View(v_point1, v_ray1, v_cell1, v_origins.zw, v_turns.zw, v_look.x);
  Seen s = Seen(vec3(0.0), vec3(0.0), 0.0, 0.0, COVER(0.0), vec2(0.0), 0.0, 0.0, 0.0);
#ifdef FAST
  // A loop of as many turns as there are pictures, for it is what software can leave early.
  for (int k = 0; k < v_pictures.x; ++k) {
    see(meet(view), view, k == 0 ? 1.0 - v_look.y : v_look.y, 1.0, s);
    view = other;
  }
#else
  vec2 texel = vec2(1.0, -1.0) / u_atlas.zw;
  mat2 pixel = mat2(across * texel, dFdy(v_texel) * texel);
  float beside_part = part_beside(), first = 1.0 - v_look.y, second = v_look.y, phase_part = 1.0 - beside_part;
  int phases = beside_part > 0.0 ? 2 : 1;
  for (int k = 0; k < phases; ++k) {
    if (k == 1) {
      view = beside(view, v_pictures.y);
      other = beside(other, v_pictures.z);
      phase_part = beside_part;
    }
    Known known = Known(s.weight > 0.01, s.along / max(s.weight, 0.01));
    Meeting m = meet(view, known, k == 0, pixel);
    Meeting others = meet(other, known, k == 0, pixel);
    if (k == 0) {  // the phase beside adds to what has been agreed on
      m.cover = agreed_cover(m, other, second, pixel);
      others.cover = agreed_cover(others, view, first, pixel);
    }
    see(m, view, first, phase_part, s);
    see(others, other, second, phase_part, s);
  }
#endif
  float coverage = 1.0;
#ifdef SMOOTH_EDGES
  // A sample is covered as a geometry's edge covers it, fully or not; what is thinner than a texel covers some of them.
  // As many samples are written, by an alpha that drivers which round it and those which round it up take for the same
  // number; those which dither it leave no holes in what is covered fully.
  vec4 covered = clamp((s.cover - 0.5) * 2.0 * max(1.0, inversesqrt(max(dot(across, across), 0.01))) + 0.5, 0.0, 1.0);
  float count = floor(dot(covered, vec4(1.0)) + 0.5);
  coverage = count > 3.5 ? 1.0 : (count - 0.3) * 0.25;
  if (coverage <= 0.0) discard;
#else
  if (s.cover < 0.5) discard;
#endif
  keep_share();
  float whole = 1.0 / max(s.weight, 1e-4);
  vec3 p = frame.eye.xyz + v_ray * (1.0 + s.along * whole);
  vec3 dyed = vec3(1.0);
  if (u_tint_regions > 0.0) dyed = textureLod(u_tint_picture, s.at, max(v_level - 1.0, 0.0)).rgb;
  leave(tinted(s.color * whole, dyed), normalize(s.n), p, v_haze);
  o_color.a = coverage;
}
