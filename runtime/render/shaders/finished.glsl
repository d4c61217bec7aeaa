// A colour of the picture before it is smoothed. DEFERRED: with its brightness, which the smoothing needs of every
// neighbour.
#ifndef FINISHED_GLSL
#define FINISHED_GLSL
vec4 finished(vec3 color) {
#ifdef DEFERRED
  return vec4(color, dot(color, vec3(0.30, 0.59, 0.11)));
#else
  return vec4(color, 1.0);
#endif
}
#endif
