// Smooths stair-steps where the driver's multisampling is too expensive: across an edge brighter on one side, two looks
// along it (after the idea of fast approximate antialiasing, Lottes 2009). DEFERRED: alpha is the brightness. SHARPEN:
// what is enlarged afterwards.
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
