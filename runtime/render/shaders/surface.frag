// MASKED: cut out by alpha. FADES: draws its share of the pattern. Without either the depth test can go first. TINTS:
// cloth takes its person's colours.
#include "outcome.glsl"
#ifdef FADES
#include "fade.glsl"
#endif
#ifdef TINTS
#include "tint.glsl"
flat in vec3 v_dyed;
#endif

centroid in vec3 v_position, v_normal;
in vec2 v_uv;
centroid in vec4 v_color;
in float v_haze;
flat in float v_layer;
uniform sampler2DArray u_textures;
uniform float u_alpha_cutoff;
#if defined(FAST) || defined(AVERAGE)
const float k_finer_levels = -0.6;  // of mip maps, where ground seen flat would blur without anisotropic filtering
#else
const float k_finer_levels = 0.0;
#endif
void main() {
#ifdef FADES
  keep_share();
#endif
  vec4 albedo = texture(u_textures, vec3(v_uv, v_layer), k_finer_levels);
  if (v_layer < 0.0) albedo = vec4(1.0);
#ifdef MASKED
  if (albedo.a * v_color.a < u_alpha_cutoff) discard;
#endif
  vec3 n = gl_FrontFacing ? v_normal : -v_normal;
  vec3 color = albedo.rgb * v_color.rgb;
#ifdef TINTS
  color = tinted(color, v_dyed);
#endif
  leave(color, n, v_position, v_haze);
}
