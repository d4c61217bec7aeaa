// Shader sources, GLSL ES 3.00: the same text runs as WebGL 2. Internal to runtime/render.
#pragma once

namespace flaneur {

inline constexpr const char* kHeader =
    "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2DShadow;\n"
    "precision highp sampler2DArray;\nprecision highp sampler2DArrayShadow;\n";

// What all programs know of the picture; FrameBlock in frame_block.h mirrors it.
inline constexpr const char* kFrame = R"(
layout(std140) uniform Frame {
  mat4 u_view_projection, u_inverse_view_projection, u_near_shadow, u_far_shadow, u_people_shadow;
  vec4 u_eye, u_to_sun, u_sun_color, u_sky_color, u_ground_color, u_haze_color, u_zenith_color;
  vec4 u_shadow_layers;  // of the near and the far map, and how far from the eye people's shadows reach; u_eye.w: pixels that a metre takes at a distance of one
};
)";

// How much of the colour at p the air on the way to the eye replaces: little enough to be mixed between the corners of a triangle.
inline constexpr const char* kHaze = R"(
float haze_at(vec3 p) { return 1.0 - exp(-distance(p, u_eye.xyz) * 0.0014); }
)";

// Light: sun with shadow maps (town near and far, people), sky and ground from all sides, haze. SHADOW_TAPS: 1 or 4 bilinear
// look-ups.
inline constexpr const char* kLight = R"(
uniform sampler2DArrayShadow u_town_shadow_map;
uniform sampler2DShadow u_people_shadow_map;
const vec2 k_taps[4] = vec2[4](vec2(-0.5, -0.5), vec2(0.5, -0.5), vec2(-0.5, 0.5), vec2(0.5, 0.5));
float town_shadow(vec3 p) {
  vec3 near = (u_near_shadow * vec4(p, 1.0)).xyz * 0.5 + 0.5, far = (u_far_shadow * vec4(p, 1.0)).xyz * 0.5 + 0.5;
  vec3 off = abs(near - 0.5);
  bool in_near = max(off.x, max(off.y, off.z)) < 0.497;
  vec4 c = in_near ? vec4(near.xy, u_shadow_layers.x, near.z - 0.0006) : vec4(far.xy, u_shadow_layers.y, far.z - 0.0012);
  vec3 beyond = abs(c.xyw - 0.5);
  if (max(beyond.x, max(beyond.y, beyond.z)) > 0.499) return 1.0;
#if SHADOW_TAPS == 1
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
  vec3 c = (u_people_shadow * vec4(p, 1.0)).xyz * 0.5 + 0.5;
  vec3 off = abs(c - 0.5);
  float rim = max(off.x, max(off.y, off.z));
  if (rim > 0.499) return 1.0;
#if SHADOW_TAPS == 1
  float sum = texture(u_people_shadow_map, vec3(c.xy, c.z - 0.0012));
#else
  vec2 texel = 1.0 / vec2(textureSize(u_people_shadow_map, 0));
  float sum = 0.0;
  for (int i = 0; i < 4; ++i) sum += 0.25 * texture(u_people_shadow_map, vec3(c.xy + k_taps[i] * texel, c.z - 0.0012));
#endif
  return mix(sum, 1.0, max(smoothstep(0.42, 0.49, rim), smoothstep(0.8, 1.0, distance(p, u_eye.xyz) / u_shadow_layers.z)));
}
vec3 lit(vec3 albedo, vec3 towards, vec3 p) {
  vec3 n = normalize(towards);
  float sun = max(dot(n, u_to_sun.xyz), 0.0);
  vec3 lifted = p + n * 0.05;
  if (sun > 0.0) sun *= town_shadow(lifted) * people_shadow(lifted);
  vec3 around = mix(u_ground_color.rgb, u_sky_color.rgb, n.y * 0.5 + 0.5);
  return albedo * (u_sun_color.rgb * sun + around);
}
vec3 shown(vec3 color, float haze) {
  // Filmic tone curve (Narkowicz's fit of ACES) and the display's 1 / 2.2 in one, fitted on [0, 5], off by at most 0.006.
  vec3 s = sqrt(mix(color, u_haze_color.rgb, haze));
  return s * (0.3955 + 3.7304 * s) / (1.0 + s * (3.9385 * s - 0.4040));
}
// Colour pictures are filtered as they are stored, in sRGB, which software does several times faster, and made linear here:
// a cubic through the curve, off by less than 0.003.
vec3 linear_from_srgb(vec3 c) { return c * (c * (c * 0.305306 + 0.682171) + 0.012523); }
)";

// What a fragment shader leaves of a surface. DEFERRED: its colour and normal, and the light follows in a pass over the picture, where
// every pixel is lit once; small triangles shade many times their own pixels in software.
inline constexpr const char* kOutcome = R"(
#ifdef DEFERRED
layout(location = 0) out vec4 o_color;    // as it is stored, in sRGB
layout(location = 1) out vec4 o_normal;
void leave(vec3 color, vec3 n, vec3 p, float haze) {
  o_color = vec4(color, 1.0);
  o_normal = vec4(n * 0.5 + 0.5, 1.0);
}
#else
out vec4 o_color;
void leave(vec3 color, vec3 n, vec3 p, float haze) {
#ifdef NORMALS
  o_color = vec4(normalize(n) * 0.5 + 0.5, 1.0);
#else
  o_color = vec4(shown(lit(linear_from_srgb(color), n, p), haze), 1.0);
#endif
}
#endif
)";

// Who is fading shares the pixels of a pattern with whom they fade into: v_share is the part of the pattern that is drawn.
inline constexpr const char* kFade = R"(
flat in vec2 v_share;
void keep_share() {
  ivec2 p = ivec2(gl_FragCoord.xy) & 3;
  int a = p.x ^ p.y;
  float rank = float(((a & 1) << 3) | ((p.y & 1) << 2) | (a & 2) | ((p.y & 2) >> 1)) / 16.0 + 1.0 / 32.0;
  if (rank < v_share.x || rank >= v_share.y) discard;
}
)";

// Of people: how far each of the avatar's tints moves its cloth's colour (runtime/pack/tint.h).
inline constexpr const char* kTintVertex = R"(
#ifndef SHADOW
layout(location = 8) in uvec4 a_tints;    // by tint: 0 its own colour, k the k-th of its others
uniform vec4 u_tint_shifts[3 * 8];
flat out vec3 v_tint0, v_tint1, v_tint2;
vec3 tint_shift(uint tint, uint chosen) { return chosen == 0u ? vec3(0.0) : u_tint_shifts[tint * 8u + chosen - 1u].rgb; }
void choose_tints() {
  v_tint0 = tint_shift(0u, a_tints.x);
  v_tint1 = tint_shift(1u, a_tints.y);
  v_tint2 = tint_shift(2u, a_tints.z);
}
#endif
)";
inline constexpr const char* kTintFragment = R"(
flat in vec3 v_tint0, v_tint1, v_tint2;
uniform vec4 u_tints[3];  // colour, with half its lightness taken off, and 1 / reach squared
float tint_share(vec3 half_light, vec4 tint) {
  vec3 off = half_light - tint.rgb;
  return clamp(2.0 - 2.0 * dot(off, off) * tint.w, 0.0, 1.0);
}
vec3 tinted(vec3 color) {
  vec3 half_light = color - 0.5 * dot(color, vec3(0.30, 0.59, 0.11));
  float share0 = tint_share(half_light, u_tints[0]);
  float share1 = min(1.0 - share0, tint_share(half_light, u_tints[1]));
  float share2 = min(1.0 - share0 - share1, tint_share(half_light, u_tints[2]));
  return clamp(color + share0 * v_tint0 + share1 * v_tint1 + share2 * v_tint2, 0.0, 1.0);
}
)";

inline constexpr const char* kTownVertex = R"(
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec4 a_normal;    // and the picture's layer
layout(location = 2) in vec2 a_uv;
layout(location = 3) in vec4 a_color;
centroid out vec3 v_position, v_normal;
out vec2 v_uv;
centroid out vec4 v_color;
out float v_haze;
flat out float v_layer;
void main() {
  v_haze = haze_at(a_position);
  v_position = a_position;
  v_normal = a_normal.xyz;
  v_layer = floor(a_normal.w * 127.0 + 0.5);
  v_uv = a_uv;
  v_color = a_color;
  gl_Position = u_view_projection * vec4(a_position, 1.0);
}
)";

// Everybody's pose is a row of the pose texture, three texels a joint. SHADOW: the rows are those of the clips' moments.
inline constexpr const char* kPersonVertex = R"(
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec4 a_normal;    // and the picture's layer
layout(location = 2) in vec2 a_uv;
layout(location = 3) in vec4 a_color;
layout(location = 4) in uvec4 a_joints;
layout(location = 5) in vec4 a_weights;
layout(location = 6) in vec4 a_place;     // position, turn about the vertical
layout(location = 7) in vec4 a_look;      // row of the pose texture, share of the pattern from, to, and 1: a prop on an impostor
uniform highp sampler2D u_poses;
#ifndef SHADOW
centroid out vec3 v_position, v_normal;
out vec2 v_uv;
centroid out vec4 v_color;
out float v_haze;
flat out float v_layer;
flat out vec2 v_share;
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
  vec3 posed = vec3(dot(r0, p), dot(r1, p), dot(r2, p));
  float c = cos(a_place.w), s = sin(a_place.w);
  vec3 place = vec3(c * posed.x + s * posed.z, posed.y, c * posed.z - s * posed.x) + a_place.xyz;
  gl_Position = u_view_projection * vec4(place, 1.0);
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
#ifdef FAST
  // A prop before the person's axis stands before their impostor, which is as deep as its front.
  if (a_look.w > 0.5) {
    vec2 to_eye = normalize(u_eye.xz - a_place.xz);
    float before_m = dot(place.xz - a_place.xz, to_eye);
    vec4 front = u_view_projection * vec4(place + vec3(to_eye.x, 0.0, to_eye.y) * (0.36 - 0.9 * before_m), 1.0);
    if (before_m > -0.02) gl_Position.z = front.z / front.w * gl_Position.w;
  }
#endif
#endif
}
)";

// SHARPER: mip levels towards the finer, where ground seen flat would blur without anisotropic filtering. MASKED: cut out by alpha. FADES: draws its share of the pattern. Without either the depth test can go first.
inline constexpr const char* kSurfaceFragment = R"(
centroid in vec3 v_position, v_normal;
in vec2 v_uv;
centroid in vec4 v_color;
in float v_haze;
flat in float v_layer;
uniform sampler2DArray u_textures;
uniform float u_alpha_cutoff;
void main() {
#ifdef FADES
  keep_share();
#endif
  vec4 albedo = texture(u_textures, vec3(v_uv, v_layer), SHARPER);
  if (v_layer < 0.0) albedo = vec4(1.0);
#ifdef MASKED
  if (albedo.a * v_color.a < u_alpha_cutoff) discard;
#endif
  vec3 n = gl_FrontFacing ? v_normal : -v_normal;
  vec3 color = albedo.rgb * v_color.rgb;
#ifdef TINTS
  color = tinted(color);
#endif
  leave(color, n, v_position, v_haze);
}
)";

inline constexpr const char* kShadowFragment = R"(
#ifdef MASKED
in vec2 v_uv;
in vec4 v_color;
flat in float v_layer;
uniform sampler2DArray u_textures;
uniform float u_alpha_cutoff;
#endif
void main() {
#ifdef MASKED
  if (v_layer >= 0.0 && texture(u_textures, vec3(v_uv, v_layer)).a * v_color.a < u_alpha_cutoff) discard;
#endif
}
)";

// A colour of the picture before it is smoothed. DEFERRED: with its brightness, which the smoothing needs of every neighbour.
inline constexpr const char* kFinished = R"(
vec4 finished(vec3 color) {
#ifdef DEFERRED
  return vec4(color, dot(color, vec3(0.30, 0.59, 0.11)));
#else
  return vec4(color, 1.0);
#endif
}
)";

// What is known of a picture's cell.
inline constexpr const char* kImpostorCells = R"(
// Three texels a cell: left, top, right, bottom; the point between the feet, sine and cosine of the elevation; the cells of the
// next and of the previous phase, -1 where there is one alone. All in texels.
uniform highp sampler2D u_cells;
vec4 cell_texel(int cell, int k) {
  int i = 3 * cell + k;
  return texelFetch(u_cells, ivec2(i % CELLS_WIDTH, i / CELLS_WIDTH), 0);
}
)";

// A quad that stands upright and turns to the eye, with the two pictures between whose directions the eye is.
inline constexpr const char* kImpostorVertex = R"(
layout(location = 0) in vec2 a_corner;    // 0 to 1
layout(location = 6) in vec4 a_place;     // position, turn about the vertical
layout(location = 7) in vec4 a_look;      // first cell of the picture's directions, share of the pattern from, to, phases since it
uniform vec4 u_atlas;                     // texture coordinates a metre, size in texels
uniform float u_directions;
uniform vec3 u_ranges;                    // as below
out vec3 v_ray;                           // from the eye to the quad
out vec3 v_point0, v_point1, v_ray0, v_ray1;  // the quad's points and v_ray in the two pictures' axes: right, up, towards whoever looks
out vec2 v_texel;                         // of the quad, as large as the atlas's
flat out vec4 v_turns;                    // cosine and sine of the two pictures' azimuths
flat out vec4 v_cell0, v_cell1, v_origins;
flat out vec4 v_look;                     // phases since the picture, share of the second one, sine and cosine of the elevation
flat out vec2 v_share;
flat out float v_haze, v_level;           // v_level: mip level, whose texels are as large as pixels
flat out ivec3 v_pictures;                // how many of the two count; their directions' cells in the phase beside, -1: none
const float k_around_px = 4.0;  // beyond both silhouettes lie those between them, and what perspective and motion make larger
vec3 in_axes_of(vec2 turn, vec2 elevation, vec3 v) {
  float out_m = dot(v.xz, turn.yx);
  return vec3(turn.x * v.x - turn.y * v.z, elevation.y * v.y - elevation.x * out_m, elevation.x * v.y + elevation.y * out_m);
}
void main() {
  vec3 from = u_eye.xyz - a_place.xyz;
  float turn = (atan(-from.z, from.x) - a_place.w) / 6.28318531 + 0.25;
  float direction = fract(turn) * u_directions;
  int first = int(a_look.x), d0 = int(direction) % int(u_directions), d1 = (d0 + 1) % int(u_directions);
  vec4 cell0 = cell_texel(first + d0, 0), cell1 = cell_texel(first + d1, 0), origin0 = cell_texel(first + d0, 1), origin1 = cell_texel(first + d1, 1);
  vec2 low = min(min(vec2(cell0.x - origin0.x, origin0.y - cell0.w), vec2(cell1.x - origin1.x, origin1.y - cell1.w)), vec2(0.0));
  vec2 high = max(max(vec2(cell0.z - origin0.x, origin0.y - cell0.y), vec2(cell1.z - origin1.x, origin1.y - cell1.y)), vec2(0.0));
  float texel_m = 1.0 / (u_atlas.x * u_atlas.z);
#ifdef FAST
  float around_px = k_around_px;
#else
  float around_px = k_around_px + min(u_ranges.y * abs(a_look.w) / texel_m, 16.0);
#endif
  vec2 at = mix(low - around_px, high + around_px, a_corner) * texel_m;
  float distance = max(length(from.xz), 1e-3);
  vec3 offset = vec3(from.z / distance * at.x, at.y, -from.x / distance * at.x);
  vec3 p = a_place.xyz + offset;
  v_ray = p - u_eye.xyz;
  vec2 azimuths = vec2(d0, d1) * 6.28318531 / u_directions + a_place.w;
  v_turns = vec4(cos(azimuths.x), sin(azimuths.x), cos(azimuths.y), sin(azimuths.y));
  v_point0 = in_axes_of(v_turns.xy, origin0.zw, offset);
  v_point1 = in_axes_of(v_turns.zw, origin0.zw, offset);
  v_ray0 = in_axes_of(v_turns.xy, origin0.zw, v_ray);
  v_ray1 = in_axes_of(v_turns.zw, origin0.zw, v_ray);
  v_texel = at * u_atlas.xy * u_atlas.zw;
  v_cell0 = cell0 / u_atlas.zwzw;
  v_cell1 = cell1 / u_atlas.zwzw;
  v_origins = vec4(origin0.xy, origin1.xy) / u_atlas.zwzw;
  v_share = a_look.yz;
  choose_tints();
  v_haze = haze_at(a_place.xyz);
  gl_Position = u_view_projection * vec4(p, 1.0);
  v_level = max(0.0, log2(max((u_view_projection * vec4(a_place.xyz, 1.0)).w, 0.1) / (u_eye.w * texel_m)));
  float between = fract(direction);
  vec2 beside0 = cell_texel(first + d0, 2).xy, beside1 = cell_texel(first + d1, 2).xy;
  v_pictures = ivec3(2, a_look.w < 0.0 ? vec2(beside0.y, beside1.y) : vec2(beside0.x, beside1.x));
#ifdef FAST
  // The smaller they are drawn, the narrower is the range of directions in which both pictures are looked up.
  v_level = floor(v_level + 0.5);  // between two levels software looks up twice as much
  between = clamp((between - 0.5) * 2.0 * exp2(v_level) + 0.5, 0.0, 1.0);
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
  // As deep as the person's front: so the ground leaves the feet, and the depth test can go before all that follows.
  vec4 front = u_view_projection * vec4(p - normalize(vec3(v_ray.x, 0.0, v_ray.z)) * 0.35, 1.0);
  gl_Position.z = front.z / front.w * gl_Position.w;
#endif
  v_look = vec4(a_look.w, between, origin0.zw);
}
)";

// A texel of a view shows a point of the person: so far before the axis, and moved on by so much since the picture's phase. Where
// the ray through a pixel meets such a point is searched for in each of the two pictures (relief mapping: Policarpo, Oliveira and
// Comba 2005); a find counts as far as the other picture does not see through there. Both of the phase beside join in the nearer the
// moment is to it, for what one phase's pictures hide the other's show.
inline constexpr const char* kImpostorViews = R"(
in vec3 v_ray, v_point0, v_point1, v_ray0, v_ray1;
in vec2 v_texel;
flat in vec4 v_turns, v_cell0, v_cell1, v_origins, v_look;
flat in float v_haze, v_level;
flat in ivec3 v_pictures;
uniform sampler2D u_texture, u_depth, u_motion;
uniform vec4 u_atlas;
uniform vec3 u_ranges;  // of depth, motion and its bend
const float k_counts = 4.0;  // a picture whose share is a quarter counts fully in what covers and hides
const float k_phase_counts = 8.0, k_beside = 0.1;  // an eighth, for phases; nearer than this to its picture, a phase has no other beside
struct View { vec3 point, ray; vec4 cell; vec2 origin, turn; float since; };  // since: phases
// Coverage at a pixel's four samples, where graphics cards take them, or at its middle.
#ifdef SMOOTH_EDGES
#define COVER vec4
const vec2 k_samples[4] = vec2[4](vec2(-0.125, -0.375), vec2(0.375, -0.125), vec2(-0.375, 0.125), vec2(0.125, 0.375));
float mean_of(vec4 cover) { return dot(cover, vec4(0.25)); }
#else
#define COVER float
float mean_of(float cover) { return cover; }
#endif
struct Meeting {
  vec2 at;       // texture coordinates
  vec3 color;    // there
  COVER cover;   // 0: the ray misses the person
  float along;   // the ray, in its length
  float trust;   // less than 1: a guess, where other parts of the person hide what the ray meets
};
COVER cover_at(vec2 at, mat2 pixel) {
#ifdef SMOOTH_EDGES
  vec4 cover;
  for (int i = 0; i < 4; ++i) cover[i] = textureLod(u_texture, at + pixel * k_samples[i], v_level).a;
  return cover;
#else
  return textureLod(u_texture, at, v_level).a;
#endif
}
vec2 within(View view, vec2 at) {
  vec2 edge = 0.5 * exp2(ceil(v_level)) / u_atlas.zw;
  return clamp(at, view.cell.xy + edge, view.cell.zw - edge);
}
bool is_within(View view, vec2 at) { return all(greaterThanEqual(at, view.cell.xy)) && all(lessThanEqual(at, view.cell.zw)); }
// Where the picture shows the ray's point at a depth, had that point moved by so much.
vec2 place_at(View view, float depth, vec2 moved) {
  vec2 p = view.point.xy + view.ray.xy / view.ray.z * (depth - view.point.z) - moved;
  return view.origin + p * vec2(u_atlas.x, -u_atlas.y);
}
// What a texel shows: its motion since the picture's phase, and depth.
vec3 moved_and_depth(View view, vec2 at) {
  float since = view.since, half_level = max(v_level - 1.0, 0.0);
#ifdef FAST
  vec3 shown = textureLod(u_depth, at, half_level).rgb * 2.0 - 1.0;  // in one picture of half the size
  return vec3(shown.gb * (u_ranges.y * since), shown.r * u_ranges.x);
#else
  vec4 way = textureLod(u_motion, at, half_level) * 2.0 - 1.0;
  float depth = textureLod(u_depth, at, v_level).r * 2.0 - 1.0;
  return vec3(way.rg * (u_ranges.y * since) + way.ba * (u_ranges.z * 4.0 * since * since), depth * u_ranges.x);
#endif
}
#ifdef FAST
// Depth and motion where the ray crosses the quad say where to look.
Meeting meet(View view, View other, float others_part, mat2 pixel) {
  vec3 guess = moved_and_depth(view, within(view, place_at(view, 0.0, vec2(0.0))));
  vec2 at = place_at(view, guess.z, guess.xy);
  vec4 color = textureLod(u_texture, within(view, at), v_level);
  return Meeting(within(view, at), color.rgb, is_within(view, at) ? color.a : 0.0, (guess.z - view.point.z) / view.ray.z, 1.0);
}
#else
// Of the phase beside, by the square of its nearness, as what motion leaves unsaid grows.
float part_beside() {
  float near = abs(v_look.x), far = 1.0 - near;
  return v_pictures.y >= 0 && near > k_beside ? near * near / (near * near + far * far) : 0.0;
}
View beside(View view, int cell) {
  float since = view.since < 0.0 ? view.since + 1.0 : view.since - 1.0;
  return View(view.point, view.ray, cell_texel(cell, 0) / u_atlas.zwzw, cell_texel(cell, 1).xy / u_atlas.zw, view.turn, since);
}
const float k_most_steps = 24.0;
const float k_solid = 0.1;         // coverage of a texel that can be met
const float k_thickness_m = 0.06;  // behind the surface by more than this and a step, the ray passes behind the person's part
const float k_exact_m = 0.03;      // between two guesses of the depth
const float k_near_m = 0.05;       // of a surface that the ray comes out beneath
// What another picture shows where a point of the ray lies: nothing if it sees through there.
COVER cover_from(View view, float along, mat2 pixel) {
  vec3 p = view.point + along * view.ray;
  vec2 at = place_at(view, p.z, vec2(0.0));
  for (int k = 0; k < 3; ++k) at = place_at(view, p.z, moved_and_depth(view, within(view, at)).xy);
  return is_within(view, at) ? cover_at(within(view, at), pixel) : COVER(0.0);
}
// Follows the ray from the person's front to the back, a texel a step, to the first surface that it comes upon. The one return at
// the end is meant: Mesa 22.3 draws some pixels wrongly in software after an early one.
Meeting meet(View view, View other, float others_part, mat2 pixel) {
  float range = u_ranges.x, texels = length((place_at(view, range, vec2(0.0)) - place_at(view, -range, vec2(0.0))) * u_atlas.zw);
  float steps = clamp(ceil(texels * exp2(-v_level)), 1.0, k_most_steps), step_m = 2.0 * range / steps;
  float gap = range, least_gap = k_near_m;
  vec3 shown = vec3(0.0), found = vec3(0.0);  // motion and depth
  bool met = false;
  for (float i = 0.0; i <= steps && !met; ++i) {
    float depth = range - i * step_m, gap_before = gap;
    vec2 at = place_at(view, depth, shown.xy);
    shown = moved_and_depth(view, within(view, at));
    gap = depth - shown.z;
    if (is_within(view, at) && textureLod(u_texture, within(view, at), v_level).a >= k_solid) {
      if (abs(gap) < least_gap) {
        least_gap = abs(gap);
        found = shown;
      }
      if (gap <= 0.0 && gap > -step_m - k_thickness_m) {
        vec3 guess = vec3(shown.xy, gap_before > 0.0 && i > 0.0 ? depth + step_m * gap / (gap - gap_before) : shown.z);
        for (int k = 0; k < 3; ++k) {
          vec3 next = moved_and_depth(view, within(view, place_at(view, guess.z, guess.xy)));
          met = abs(next.z - guess.z) < k_exact_m;
          guess = next;
        }
        if (met) found = guess;
      }
    } else {
      gap = -1.0;  // what comes next is entered from the side
    }
  }
  vec2 ends = place_at(view, found.z, found.xy), at = within(view, ends);
  float along = (found.z - view.point.z) / view.ray.z;
  COVER cover = COVER(0.0);
  if (is_within(view, ends) && (met || least_gap < k_near_m)) {
    cover = cover_at(at, pixel);
    if (others_part > 0.0) cover = min(cover, max(cover_from(other, along, pixel), COVER(1.0 - k_counts * others_part)));
  }
  return Meeting(at, textureLod(u_texture, at, v_level).rgb, cover, along, met ? 1.0 : 0.02);
}
#endif
)";

inline constexpr const char* kImpostorFragment = R"(
uniform sampler2D u_normals;
const float k_hides = 0.999;  // not all: straight from a picture's direction it alone has a share
vec3 normal_at(View view, vec2 at) {
#ifdef FAST
  float level = max(v_level - 1.0, 0.0);
#else
  float level = v_level;
#endif
  vec2 square = textureLod(u_normals, at, level).rg * 2.0 - 1.0, p = vec2(square.x + square.y, square.x - square.y) * 0.5;
  float near = 1.0 - abs(p.x) - abs(p.y), out_m = v_look.w * near - v_look.z * p.y;
  return vec3(view.turn.x * p.x + view.turn.y * out_m, v_look.w * p.y + v_look.z * near, view.turn.x * out_m - view.turn.y * p.x);
}
void main() {
  vec2 across = dFdx(v_texel), texel = vec2(1.0, -1.0) / u_atlas.zw;
  mat2 pixel = mat2(across * texel, dFdy(v_texel) * texel);
  View view = View(v_point0, v_ray0, v_cell0, v_origins.xy, v_turns.xy, v_look.x);
  View other = View(v_point1, v_ray1, v_cell1, v_origins.zw, v_turns.zw, v_look.x);
  COVER cover = COVER(0.0);
  vec3 color = vec3(0.0), n = vec3(0.0);
  float along = 0.0, weight = 0.0, covered_before = 0.0, parts_before = 0.0, phase_part = 1.0;
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
  // A sample is covered as a geometry's edge covers it, fully or not; what is thinner than a texel covers some of them. As many
  // samples are written, by an alpha that drivers which round it and those which round it up take for the same number.
  vec4 covered = clamp((cover - 0.5) * 2.0 * max(1.0, inversesqrt(max(dot(across, across), 0.01))) + 0.5, 0.0, 1.0);
  coverage = (floor(dot(covered, vec4(1.0)) + 0.5) - 0.3) * 0.25;
  if (coverage <= 0.0) discard;
#else
  if (cover < 0.5) discard;
#endif
  keep_share();
  float whole = 1.0 / max(weight, 1e-4);
  vec3 p = u_eye.xyz + v_ray * (1.0 + along * whole);
#ifndef FAST
  vec4 clip = u_view_projection * vec4(p, 1.0);
  gl_FragDepth = clip.z / clip.w * 0.5 + 0.5;
#endif
  leave(tinted(color * whole), normalize(n), p, v_haze);
  o_color.a = coverage;
}
)";

inline constexpr const char* kSkyVertex = R"(
out vec3 v_ray;
void main() {
  vec2 p = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0;
  gl_Position = vec4(p, 1.0, 1.0);
  vec4 a = u_inverse_view_projection * vec4(p, 1.0, 1.0), b = u_inverse_view_projection * vec4(p, -1.0, 1.0);
  v_ray = a.xyz / a.w - b.xyz / b.w;
}
)";

inline constexpr const char* kSkyFragment = R"(
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
  vec3 color = mix(u_haze_color.rgb, u_zenith_color.rgb, pow(up, 0.45));
  vec2 q = d.xz / (up + 0.12) * 1.4;
  float cloud = noise(q) * 0.55 + noise(q * 2.3 + 7.0) * 0.3 + noise(q * 5.1) * 0.15;
  color = mix(color, 0.35 * u_haze_color.rgb + 0.85 * u_sky_color.rgb + 0.06 * u_sun_color.rgb, smoothstep(0.52, 0.85, cloud) * smoothstep(0.02, 0.25, d.y) * 0.65);
  float glow = max(dot(d, u_to_sun.xyz), 0.0);
  color += u_sun_color.rgb * (pow(glow, 500.0) * 4.0 + pow(glow, 12.0) * 0.08);
  color = (color * (2.51 * color + 0.03)) / (color * (2.43 * color + 0.59) + 0.14);
  o_color = finished(pow(clamp(color, 0.0, 1.0), vec3(1.0 / 2.2)));
}
)";

// The light of every pixel, from what DEFERRED left of it.
inline constexpr const char* kLightVertex = R"(
out vec4 v_near, v_far;  // ends of the ray through a pixel, homogeneous: the depth divides it evenly
void main() {
  vec2 p = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0;
  gl_Position = vec4(p, 1.0, 1.0);  // behind everything
  v_near = u_inverse_view_projection * vec4(p, -1.0, 1.0);
  v_far = u_inverse_view_projection * vec4(p, 1.0, 1.0);
}
)";
inline constexpr const char* kLightFragment = R"(
in vec4 v_near, v_far;
uniform sampler2D u_texture, u_normals;
uniform highp sampler2D u_depth;
out vec4 o_color;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec3 color = texelFetch(u_texture, at, 0).rgb, n = texelFetch(u_normals, at, 0).xyz * 2.0 - 1.0;
  vec4 p = mix(v_near, v_far, texelFetch(u_depth, at, 0).r);
  p.xyz /= p.w;
  o_color = finished(shown(lit(linear_from_srgb(color), n, p.xyz), haze_at(p.xyz)));
}
)";

// A triangle over the whole picture.
inline constexpr const char* kWholeVertex = R"(
void main() {
  gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0);
}
)";

// Smooths stair-steps where the driver's multisampling is too dear: across an edge brighter on one side, two looks along it
// (after the idea of fast approximate antialiasing, Lottes 2009). DEFERRED: alpha is the brightness. SHARPEN: what
// is enlarged afterwards.
inline constexpr const char* kSmoothFragment = R"(
uniform sampler2D u_texture;
out vec4 o_color;
#ifdef SHARPEN
#define SHARPNESS 0.6
#endif
float brightness_of(vec4 c) {
#ifdef DEFERRED
  return c.a;
#else
  return dot(c.rgb, vec3(0.30, 0.59, 0.11));
#endif
}
float brightness(ivec2 p) { return brightness_of(texelFetch(u_texture, p, 0)); }
void main() {
  ivec2 last = textureSize(u_texture, 0) - 1, p = ivec2(gl_FragCoord.xy);
  vec4 middle = texelFetch(u_texture, p, 0);
  int left = max(p.x - 1, 0), right = min(p.x + 1, last.x), below = max(p.y - 1, 0), above = min(p.y + 1, last.y);
  float m = brightness_of(middle);
  float lb = brightness(ivec2(left, below)), rb = brightness(ivec2(right, below));
  float la = brightness(ivec2(left, above)), ra = brightness(ivec2(right, above));
  float least = min(m, min(min(lb, rb), min(la, ra))), most = max(m, max(max(lb, rb), max(la, ra)));
  vec2 along = vec2(la + ra - lb - rb, lb + la - rb - ra);  // turned a quarter from the slope of brightness
  float weaker = min(abs(along.x), abs(along.y)) + max(0.008, (lb + rb + la + ra) * 0.03);
  along = clamp(along / weaker, -6.0, 6.0) / vec2(last + 1);
  vec2 at = gl_FragCoord.xy / vec2(last + 1);
  vec4 near = 0.5 * (texture(u_texture, at - along / 6.0) + texture(u_texture, at + along / 6.0));
  vec4 far = 0.5 * near + 0.25 * (texture(u_texture, at - along * 0.5) + texture(u_texture, at + along * 0.5));
  float b = brightness_of(far);
  vec3 smoothed = b < least || b > most ? near.rgb : far.rgb;
#ifdef SHARPEN
  // Enlarging blurs: brightness is set off against the neighbours', but never beyond theirs.
  float sharp = clamp(m + SHARPNESS * (m - 0.25 * (lb + rb + la + ra)), least, most);
  middle.rgb *= sharp / max(m, 0.004);
#endif
  o_color = vec4(most - least < max(0.06, most * 0.14) ? middle.rgb : smoothed, 1.0);
}
)";

// The same, with places in the texture that fills it.
inline constexpr const char* kEnlargeVertex = R"(
out vec2 v_at;
void main() {
  v_at = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
  gl_Position = vec4(v_at * 2.0 - 1.0, 0.0, 1.0);
}
)";
inline constexpr const char* kEnlargeFragment = R"(
in vec2 v_at;
uniform sampler2D u_texture;
out vec4 o_color;
void main() { o_color = texture(u_texture, v_at); }
)";

// A strip of text at the foot of the picture, pixel by pixel.
inline constexpr const char* kCaptionFragment = R"(
uniform sampler2D u_texture;
uniform float u_share;
out vec4 o_color;
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  o_color = texelFetch(u_texture, ivec2(p.x, textureSize(u_texture, 0).y - 1 - p.y), 0);
  o_color.a *= u_share;
}
)";

// A mark on the ground, in ground axes, as if it shone.
inline constexpr const char* kGroundMarkVertex = R"(
layout(location = 0) in vec3 a_place;
void main() { gl_Position = u_view_projection * vec4(a_place.x, a_place.z, -a_place.y, 1.0); }
)";
inline constexpr const char* kGroundMarkFragment = R"(
out vec4 o_color;
void main() { o_color = vec4(1.0, 0.82, 0.40, 0.8); }
)";

// Dear ImGui's triangles: places in pixels from the upper left corner, colours as they are shown.
inline constexpr const char* kOverlayVertex = R"(
layout(location = 0) in vec2 a_place;
layout(location = 1) in vec2 a_uv;
layout(location = 2) in vec4 a_color;
uniform vec3 u_size;
out vec2 v_uv;
out vec4 v_color;
void main() {
  v_uv = a_uv;
  v_color = a_color;
  gl_Position = vec4(a_place.x / u_size.x * 2.0 - 1.0, 1.0 - a_place.y / u_size.y * 2.0, 0.0, 1.0);
}
)";
inline constexpr const char* kOverlayFragment = R"(
in vec2 v_uv;
in vec4 v_color;
uniform sampler2D u_texture;
out vec4 o_color;
void main() { o_color = vec4(v_color.rgb, v_color.a * texture(u_texture, v_uv).r); }
)";

}  // namespace flaneur
