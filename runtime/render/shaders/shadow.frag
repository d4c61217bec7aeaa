// Depth alone. MASKED: cut out by alpha.
#ifdef MASKED
in vec2 v_uv;
centroid in vec4 v_color;
flat in float v_layer;
uniform sampler2DArray u_textures;
uniform float u_alpha_cutoff;
#endif
void main() {
#ifdef MASKED
  if (v_layer >= 0.0 && texture(u_textures, vec3(v_uv, v_layer)).a * v_color.a < u_alpha_cutoff) discard;
#endif
}
