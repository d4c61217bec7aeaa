// The pack's pictures as textures. Internal to runtime/render.
#pragma once
#include <GLES3/gl3.h>

#include <array>
#include <vector>

#include "runtime/pack/tour_pack.h"
#include "runtime/render/surface_plan.h"

namespace flaneur {

// One a planned array, grey until its layers arrive; they repeat.
// fast: from one mip level, for a look-up between two costs software twice as much.
std::vector<GLuint> CreateTextureArrays(const SurfacePlan& plan, bool fast);
void UploadLayer(GLuint texture, const TextureArrayPlan& array, int layer,
                 const std::vector<std::vector<uint8_t>>& levels);
bool ReadsBc1();  // needs a context

inline constexpr size_t kAtlasPictures = 5;

// An impostor's picture as it is uploaded: blocks where OpenGL reads them and `decode` is not asked for, else texels.
struct AtlasPicture {
  TextureFormat format = TextureFormat::kBc7Srgb;
  int width_px = 0, height_px = 0;
  bool blocks = false;
  std::vector<std::vector<uint8_t>> levels;
};
AtlasFormats FormatsOfThisMachine(
    bool fast);  // needs a context; in software no blocks: there one is decoded for every look-up
// Albedo, normals, depth, motion, where tints may dye (empty: everywhere). Where details are packed motion is with the
// depth, as colour, and its own picture is empty.
std::array<AtlasPicture, kAtlasPictures> PrepareAtlas(const PackImpostor& atlas, const AtlasFormats& formats);
GLuint UploadAtlasPicture(const AtlasPicture& picture);  // 0 where it is empty

}  // namespace flaneur
