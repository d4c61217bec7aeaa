// The pack's pictures as textures. Internal to runtime/render.
#pragma once
#include <GLES3/gl3.h>

#include <array>
#include <vector>

#include "runtime/pack/tour_pack.h"
#include "runtime/render/surface_plan.h"

namespace flaneur {

// One a planned array, grey until its layers arrive; they repeat.
std::vector<GLuint> CreateTextureArrays(const SurfacePlan& plan);
void UploadLayer(GLuint array, int layer, const std::vector<PackImage>& levels);

// An impostor's picture as it is uploaded: blocks where OpenGL reads them and `decode` is not asked for, else texels.
struct AtlasPicture {
  TextureFormat format = TextureFormat::kBc7Srgb;
  int width_px = 0, height_px = 0;
  bool blocks = false;
  std::vector<std::vector<uint8_t>> levels;
};
struct AtlasFormats { bool bc7_blocks = false, rgtc_blocks = false; };  // that OpenGL reads
AtlasFormats FormatsOfThisMachine();  // needs a context; in software none: there a block is decoded for every look-up
AtlasPicture PrepareAtlasPicture(PackTexture picture, const AtlasFormats& formats);
GLuint UploadAtlasPicture(const AtlasPicture& picture);

}  // namespace flaneur
