// Who is fading shares the pixels of a pattern with whom they fade into: v_share is the part of the pattern that is
// drawn.
#ifndef FADE_GLSL
#define FADE_GLSL
flat in vec2 v_share;
void keep_share() {
  ivec2 p = ivec2(gl_FragCoord.xy) & 3;
  int a = p.x ^ p.y;
  float rank = float(((a & 1) << 3) | ((p.y & 1) << 2) | (a & 2) | ((p.y & 2) >> 1)) / 16.0 + 1.0 / 32.0;
  if (rank < v_share.x || rank >= v_share.y) discard;
}
#endif
