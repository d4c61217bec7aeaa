#include "color.glsl"
void main() { o_color = color(); }
