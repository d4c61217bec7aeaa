// A texel of a view shows a point of the person: so far before the axis, and moved on by so much since the picture's
// phase. Where the ray through a pixel meets such a point is searched for in each of the two pictures (relief mapping:
// Policarpo, Oliveira and Comba 2005); a find counts as far as the other picture does not see through there. Both of
// the phase beside join in the nearer the moment is to it, for what one phase's pictures hide the other's show.
#ifndef IMPOSTOR_VIEWS_GLSL
#define IMPOSTOR_VIEWS_GLSL
#include "impostor_cells.glsl"

in vec3 v_ray, v_point0, v_point1, v_ray0, v_ray1;
in vec2 v_texel;
flat in vec4 v_turns, v_cell0, v_cell1, v_origins, v_look;
flat in float v_haze, v_level, v_normals_level, v_texels;
flat in ivec3 v_pictures;
uniform sampler2D u_texture, u_depth, u_motion;
uniform vec4 u_atlas;
uniform vec3 u_ranges;  // of depth, motion and its bend
const float k_counts = 4.0;  // a picture whose share is a quarter counts fully in what covers and hides
const float k_phase_counts = 8.0;  // an eighth, for phases
const float k_beside = 0.1;  // nearer than this to its picture, a phase has no other beside
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
  vec2 edge = 0.5 * exp2(ceil(v_level)) * v_texels / u_atlas.zw;
  return clamp(at, view.cell.xy + edge, view.cell.zw - edge);
}
bool is_within(View view, vec2 at) {
  return all(greaterThanEqual(at, view.cell.xy)) && all(lessThanEqual(at, view.cell.zw));
}
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
Meeting meet(View view) {
  vec3 guess = moved_and_depth(view, within(view, place_at(view, 0.0, vec2(0.0))));
  vec2 at = place_at(view, guess.z, guess.xy);
  vec4 color = textureLod(u_texture, within(view, at), v_level);
  float along = (guess.z - view.point.z) / view.ray.z;
  return Meeting(within(view, at), color.rgb, is_within(view, at) ? color.a : 0.0, along, 1.0);
}
#else
// Of the phase beside, by the square of its nearness, as what motion leaves unsaid grows.
float part_beside() {
  float near = abs(v_look.x), far = 1.0 - near;
  return v_pictures.y >= 0 && near > k_beside ? near * near / (near * near + far * far) : 0.0;
}
View beside(View view, int cell) {
  float since = view.since < 0.0 ? view.since + 1.0 : view.since - 1.0;
  vec4 rectangle = cell_texel(cell, 0) / u_atlas.zwzw;
  return View(view.point, view.ray, rectangle, cell_texel(cell, 1).xy / u_atlas.zw, view.turn, since);
}
const float k_most_steps = 8.0, k_texels_a_step = 3.0;
const float k_solid = 0.1;         // coverage of a texel that can be met
const float k_thickness_m = 0.06;  // behind the surface by more than this and a step, the ray passes behind it
const float k_exact_m = 0.03;      // between two guesses of the depth
const float k_near_m = 0.05;       // of a surface that the ray comes out beneath
const float k_guess_trust = 0.02;  // of what the ray does not come upon but passes
// What another picture shows where a point of the ray lies: nothing if it sees through there.
COVER cover_from(View view, float along, mat2 pixel) {
  vec3 p = view.point + along * view.ray;
  vec2 unmoved = place_at(view, p.z, vec2(0.0)), at = place_at(view, p.z, moved_and_depth(view, within(view, unmoved)).xy);
  return is_within(view, at) ? cover_at(within(view, at), pixel) : COVER(0.0);
}
// How many steps take the ray from the person's front to the back.
float steps_through(View view) {
  vec2 front = place_at(view, u_ranges.x, vec2(0.0)), back = place_at(view, -u_ranges.x, vec2(0.0));
  float texels = length((front - back) * u_atlas.zw);
  return clamp(ceil(texels * exp2(-v_level) / (k_texels_a_step * v_texels)), 1.0, k_most_steps);
}
bool is_solid(View view, vec2 at) {
  return is_within(view, at) && textureLod(u_texture, within(view, at), v_level).a >= k_solid;
}
// The depth of a straight surface between two steps of the ray, one before it and one behind.
float depth_between(float depth, float step_m, float gap, float gap_before) {
  return depth + step_m * gap / (gap - gap_before);
}
// What the picture shows where a guess lies, and where that lies again; exact: it comes to rest.
vec3 refined(View view, vec3 guess, out bool exact) {
  for (int k = 0; k < 3; ++k) {
    vec3 next = moved_and_depth(view, within(view, place_at(view, guess.z, guess.xy)));
    exact = abs(next.z - guess.z) < k_exact_m;
    guess = next;
  }
  return guess;
}
// The first surface that the ray comes upon from the person's front to the back, or else the nearest that it passes.
struct Surface {
  vec3 shown;   // motion and depth
  bool met;     // it comes upon it,
  bool passed;  // or past it nearer than k_near_m
};
Surface first_surface(View view) {
  float steps = steps_through(view), step_m = 2.0 * u_ranges.x / steps;
  float gap = u_ranges.x, least_gap = k_near_m;  // from the ray back to the surface that the picture shows there
  vec3 shown = vec3(0.0), found = vec3(0.0);
  bool met = false;
  for (float i = 0.0; i <= steps && !met; ++i) {
    float depth = u_ranges.x - i * step_m, gap_before = gap;
    vec2 at = place_at(view, depth, shown.xy);
    shown = moved_and_depth(view, within(view, at));
    gap = depth - shown.z;
    if (is_solid(view, at)) {
      if (abs(gap) < least_gap) {
        least_gap = abs(gap);
        found = shown;
      }
      if (gap <= 0.0 && gap > -step_m - k_thickness_m) {
        bool came_from_before = gap_before > 0.0 && i > 0.0;
        float met_at = came_from_before ? depth_between(depth, step_m, gap, gap_before) : shown.z;
        vec3 surface = refined(view, vec3(shown.xy, met_at), met);
        if (met) found = surface;
      }
    } else {
      gap = -1.0;  // what comes next is entered from the side
    }
  }
  return Surface(found, met, least_gap < k_near_m);
}
const float k_edge_levels = 2.0;  // that coarse a texel beside the person still has of them
const float k_edge_cover = 0.05;
// What is known of a ray: where, in its length, it comes upon the person in the pictures of the phase before.
struct Known { bool anything; float along; };
// Nearly everywhere a guess comes to rest at once, from what is known or from the person's axis. Where it does not on the
// person, or does beside them, there are edges, and `follows` the ray through them. Followed through the phase beside as well
// it finds no more of the person, for nearly half of all that an impostor costs.
Surface surface_met(View view, Known known, bool follows) {
  bool exact;
  vec3 shown = refined(view, vec3(0.0, 0.0, known.anything ? view.point.z + known.along * view.ray.z : 0.0), exact);
  vec2 ends = place_at(view, shown.z, shown.xy);
  bool solid = is_solid(view, ends);
  Surface surface = Surface(shown, exact && solid, exact && solid);
  if (follows) {
    bool beside = !solid && textureLod(u_texture, within(view, ends), v_level + k_edge_levels).a > k_edge_cover;
    if (beside || (solid && !exact)) surface = first_surface(view);
  }
  return surface;
}
// None of these returns early: Mesa 22.3 draws some pixels wrongly in software after that.
Meeting meet(View view, Known known, bool follows, mat2 pixel) {
  Surface surface = surface_met(view, known, follows);
  vec2 ends = place_at(view, surface.shown.z, surface.shown.xy), at = within(view, ends);
  float along = (surface.shown.z - view.point.z) / view.ray.z;
  COVER cover = COVER(0.0);
  if (is_within(view, ends) && (surface.met || surface.passed)) cover = cover_at(at, pixel);
  return Meeting(at, textureLod(u_texture, at, v_level).rgb, cover, along, surface.met ? 1.0 : k_guess_trust);
}
// How much of the pixel the person covers where the ray meets it, as far as the other picture, whose share is `part`,
// does not see through there.
COVER agreed_cover(Meeting m, View other, float part, mat2 pixel) {
  COVER cover = m.cover;
  if (part > 0.0 && mean_of(cover) > 0.0) {
    cover = min(cover, max(cover_from(other, m.along, pixel), COVER(1.0 - k_counts * part)));
  }
  return cover;
}
#endif
#endif
