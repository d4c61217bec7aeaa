// The pack's pictures as textures. Internal to runtime/render.
#pragma once
#include <GLES3/gl3.h>

#include <vector>

#include "runtime/pack/tour_pack.h"

namespace flaneur {

// One a pack image; they repeat.
std::vector<GLuint> UploadTextures(const TourPack& pack);
// Of an impostor atlas: as blocks where OpenGL reads them and `decode` is not asked for, else decoded. Software decodes a block
// for every look-up.
GLuint UploadAtlasPicture(const PackTexture& picture, bool decode);
GLuint UploadWhite();

struct Surface { GLuint texture = 0; float alpha_cutoff = 0; bool masked = false, double_sided = false; };
// One a pack material; after them the one of primitives without material.
std::vector<Surface> MakeSurfaces(const TourPack& pack, const std::vector<GLuint>& textures);

}  // namespace flaneur
