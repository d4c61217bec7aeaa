out vec4 o_color;
#ifdef BROKEN
vec3 color() { return vec3(1.0); }
#else
vec4 color() { return vec4(1.0); }
#endif
