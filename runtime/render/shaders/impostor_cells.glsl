// What is known of a picture's cell.
#ifndef IMPOSTOR_CELLS_GLSL
#define IMPOSTOR_CELLS_GLSL
#include "shared.glsl"

// Three texels a cell: left, top, right, bottom; the point between the feet, sine and cosine of the elevation; the
// cells of the next and of the previous phase, -1 where there is one alone. All in texels.
uniform highp sampler2D u_cells;
vec4 cell_texel(int cell, int k) {
  int i = 3 * cell + k;
  return texelFetch(u_cells, ivec2(i % CELLS_WIDTH, i / CELLS_WIDTH), 0);
}
#endif
