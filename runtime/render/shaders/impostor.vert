// A quad that stands upright and turns to the eye, with the two pictures between whose directions the eye is.
#include "shared.glsl"
#include "frame.glsl"
#include "haze.glsl"
#include "impostor_cells.glsl"
#include "impostor_depth.glsl"
#include "tint_choice.glsl"

layout(location = ATTRIBUTE_POSITION) in vec2 a_corner;  // 0 to 1
layout(location = ATTRIBUTE_PLACE) in vec4 a_place;      // position, turn about the vertical
// First cell of the picture's directions, share of the pattern from, to, phases since it.
layout(location = ATTRIBUTE_LOOK) in vec4 a_look;
uniform sampler2D u_texture, u_normals;
uniform vec4 u_atlas;       // texture coordinates a metre, size in texels
uniform float u_directions;
uniform vec3 u_ranges;      // of depth, motion and its bend
out vec3 v_ray;             // from the eye to the quad
// The quad's points and v_ray in the two pictures' axes: right, up, towards whoever looks.
out vec3 v_point0, v_point1, v_ray0, v_ray1;
out vec2 v_texel;           // of the quad, as large as the atlas's
flat out vec4 v_turns;      // cosine and sine of the two pictures' azimuths
flat out vec4 v_cell0, v_cell1, v_origins;
flat out vec4 v_look;       // phases since the picture, share of the second one, sine and cosine of the elevation
flat out vec2 v_share;
// v_level: mip level, whose texels are as large as pixels; normals may be a coarser picture. v_texels: so many of the atlas's a texel of the finest level
// that is there has in a row.
flat out float v_haze, v_level, v_normals_level, v_texels;
flat out ivec3 v_pictures;  // how many of the two count; their directions' cells in the phase beside, -1: none
// Beyond both silhouettes lie those between them, and what perspective and motion make larger.
const float k_around_px = 4.0;
vec3 in_axes_of(vec2 turn, vec2 elevation, vec3 v) {
  float out_m = dot(v.xz, turn.yx);
  float right_m = turn.x * v.x - turn.y * v.z;
  return vec3(right_m, elevation.y * v.y - elevation.x * out_m, elevation.x * v.y + elevation.y * out_m);
}
void main() {
  vec3 from = frame.eye.xyz - a_place.xyz;
  float turn = (atan(-from.z, from.x) - a_place.w) / 6.28318531 + 0.25;
  float direction = fract(turn) * u_directions;
  int first = int(a_look.x), d0 = int(direction) % int(u_directions), d1 = (d0 + 1) % int(u_directions);
  vec4 cell0 = cell_texel(first + d0, 0), cell1 = cell_texel(first + d1, 0);
  vec4 origin0 = cell_texel(first + d0, 1), origin1 = cell_texel(first + d1, 1);
  vec2 low0 = vec2(cell0.x - origin0.x, origin0.y - cell0.w), high0 = vec2(cell0.z - origin0.x, origin0.y - cell0.y);
  vec2 low1 = vec2(cell1.x - origin1.x, origin1.y - cell1.w), high1 = vec2(cell1.z - origin1.x, origin1.y - cell1.y);
  vec2 low = min(min(low0, low1), vec2(0.0)), high = max(max(high0, high1), vec2(0.0));
  vec3 size = person_size();
  float texel_m = 1.0 / (u_atlas.x * u_atlas.z);
#ifdef FAST
  float around_px = k_around_px;
#else
  float around_px = k_around_px + min(u_ranges.y * abs(a_look.w) / texel_m, 16.0);
#endif
  vec2 at = mix(low - around_px, high + around_px, a_corner) * texel_m;
  float distance = max(length(from.xz), 1e-3);
  vec3 offset = vec3(from.z / distance * at.x, at.y, -from.x / distance * at.x);
  vec3 p = a_place.xyz + offset * size;
  v_ray = p - frame.eye.xyz;
  vec2 azimuths = vec2(d0, d1) * 6.28318531 / u_directions + a_place.w;
  v_turns = vec4(cos(azimuths.x), sin(azimuths.x), cos(azimuths.y), sin(azimuths.y));
  v_point0 = in_axes_of(v_turns.xy, origin0.zw, offset);
  v_point1 = in_axes_of(v_turns.zw, origin0.zw, offset);
  v_ray0 = in_axes_of(v_turns.xy, origin0.zw, v_ray / size);
  v_ray1 = in_axes_of(v_turns.zw, origin0.zw, v_ray / size);
  v_texel = at * u_atlas.xy * u_atlas.zw;
  v_cell0 = cell0 / u_atlas.zwzw;
  v_cell1 = cell1 / u_atlas.zwzw;
  v_origins = vec4(origin0.xy, origin1.xy) / u_atlas.zwzw;
  v_share = a_look.yz;
  choose_tints();
  v_haze = haze_at(a_place.xyz);
  gl_Position = frame.view_projection * vec4(p, 1.0);
  float before_m = min(plane_before_axis_m(p.y - a_place.y), 0.5 * length(v_ray.xz));
  put_as_deep_as(p - normalize(vec3(v_ray.x, 0.0, v_ray.z)) * before_m);
  v_texels = u_atlas.z / float(textureSize(u_texture, 0).x);
  v_level = max(0.0, log2(max((frame.view_projection * vec4(a_place.xyz, 1.0)).w, 0.1) / (frame.eye.w * texel_m * v_texels * size.y)));
  float between = fract(direction);
  vec2 beside0 = cell_texel(first + d0, 2).xy, beside1 = cell_texel(first + d1, 2).xy;
  v_pictures = ivec3(2, a_look.w < 0.0 ? vec2(beside0.y, beside1.y) : vec2(beside0.x, beside1.x));
#ifdef FAST
  // The smaller they are drawn, the narrower is the range of directions in which both pictures are looked up.
  v_level = floor(v_level + 0.5);  // between two levels software looks up twice as much
  between = clamp((between - 0.5) * 2.0 * exp2(v_level) * v_texels + 0.5, 0.0, 1.0);
  if (between <= 0.0) v_pictures.x = 1;
  if (between >= 1.0) {
    v_pictures.x = 1;
    between = 0.0;
    v_point0 = v_point1;
    v_ray0 = v_ray1;
    v_turns.xy = v_turns.zw;
    v_cell0 = v_cell1;
    v_origins.xy = v_origins.zw;
  }
#endif
  v_look = vec4(a_look.w, between, origin0.zw);
  v_normals_level = max(0.0, v_level - log2(float(textureSize(u_texture, 0).x) / float(textureSize(u_normals, 0).x)));
}
