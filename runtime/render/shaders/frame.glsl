#ifndef FRAME_GLSL
#define FRAME_GLSL
#define FIELD(type, name) type name;
layout(std140) uniform Frame {
#include "frame_fields.glsl"
} frame;
#undef FIELD
#endif
