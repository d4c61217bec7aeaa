// The pack's pictures as textures. Internal to runtime/render.
#pragma once
#include <GLES3/gl3.h>

#include <array>
#include <vector>

#include "runtime/render/atlas_pictures.h"
#include "runtime/render/surface_plan.h"

namespace flaneur {

// One a planned array, grey until its layers arrive; they repeat.
// fast: from one mip level, for a look-up between two costs software twice as much.
std::vector<GLuint> CreateTextureArrays(const SurfacePlan& plan, bool fast);
bool ReadsBc1();  // needs a context

// The rows of texels that come next of a picture on its way.
struct UploadPlace {
  size_t level = 0;
  int row_px = 0;
};
// About so many bytes more; true: all of the layer is there.
bool UploadLayer(size_t most_bytes, GLuint texture, const TextureArrayPlan& array, int layer,
                 const std::vector<std::vector<uint8_t>>& levels, UploadPlace* next);

// Needs a context. fast: for many pictures a second.
AtlasFormats FormatsOfThisMachine(bool fast);

// An atlas on its way, in parts.
struct AtlasUpload {
  std::array<GLuint, kAtlasPictures> textures{};  // 0 of a picture that is empty
  size_t picture = 0;                             // that comes next
  UploadPlace next;                               // of it
};
// Likewise of all its pictures.
bool UploadAtlas(size_t most_bytes, const std::array<AtlasPicture, kAtlasPictures>& pictures, AtlasUpload* upload);

}  // namespace flaneur
