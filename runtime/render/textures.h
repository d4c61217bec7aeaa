// The pack's pictures as textures. Internal to runtime/render.
#pragma once
#include <GLES3/gl3.h>

#include <vector>

#include "runtime/render/atlas_pictures.h"
#include "runtime/render/surface_plan.h"

namespace flaneur {

// One a planned array, grey until its layers arrive; they repeat.
// fast: from one mip level, for a look-up between two costs software twice as much.
std::vector<GLuint> CreateTextureArrays(const SurfacePlan& plan, bool fast);
void UploadLayer(GLuint texture, const TextureArrayPlan& array, int layer,
                 const std::vector<std::vector<uint8_t>>& levels);
bool ReadsBc1();  // needs a context

// Needs a context. fast: for many pictures a second.
AtlasFormats FormatsOfThisMachine(bool fast);
GLuint UploadAtlasPicture(const AtlasPicture& picture);  // 0 where it is empty

}  // namespace flaneur
