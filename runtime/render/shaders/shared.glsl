// What shaders and C++ both know by number; read by both.
#ifndef FLANEUR_SHARED_GLSL
#define FLANEUR_SHARED_GLSL

// Places of vertex attributes: of a corner,
#define ATTRIBUTE_POSITION 0
#define ATTRIBUTE_NORMAL 1
#define ATTRIBUTE_UV 2
#define ATTRIBUTE_COLOR 3
#define ATTRIBUTE_JOINTS 4
#define ATTRIBUTE_WEIGHTS 5
// and of an instance.
#define ATTRIBUTE_PLACE 6
#define ATTRIBUTE_LOOK 7
#define ATTRIBUTE_TINTS 8
// Of a corner, too: which tints may dye it.
#define ATTRIBUTE_DYED 9

// Of an avatar, and of a tint besides its own.
#define MAX_TINTS 3
#define MAX_TINT_COLORS 8

// Of a person's size and breadth in ATTRIBUTE_TINTS: what stands for the pack's own, and a step, as a share of it.
#define SIZE_MIDDLE 128.0
#define SIZE_STEP 0.001

// Of the texture of all impostor cells, in texels.
#define CELLS_WIDTH 1024

#endif
