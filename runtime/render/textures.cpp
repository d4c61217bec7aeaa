#include "runtime/render/textures.h"

#include <GLES2/gl2ext.h>

#include <algorithm>
#include <cstring>

#include "runtime/render/gl_objects.h"

namespace flaneur {
namespace {

constexpr size_t kImpostorMaxLevel = kCoarsestAtlasLevel;

void SetFilters(GLenum target, GLint wrap, GLint most_level, bool between_levels) {
  glTexParameteri(target, GL_TEXTURE_WRAP_S, wrap);
  glTexParameteri(target, GL_TEXTURE_WRAP_T, wrap);
  glTexParameteri(target, GL_TEXTURE_MIN_FILTER, between_levels ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR_MIPMAP_NEAREST);
  glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, most_level);
}

bool HasExtension(const char* name) {
  const auto* extensions = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
  return extensions != nullptr && std::strstr(extensions, name) != nullptr;
}

struct BlockFormat {
  GLenum compressed, internal, format;
  const char* extension;
};

BlockFormat FormatOf(TextureFormat format) {
  switch (format) {
    case TextureFormat::kBc4:
      return {GL_COMPRESSED_RED_RGTC1_EXT, GL_R8, GL_RED, "GL_EXT_texture_compression_rgtc"};
    case TextureFormat::kBc5:
      return {GL_COMPRESSED_RED_GREEN_RGTC2_EXT, GL_RG8, GL_RG, "GL_EXT_texture_compression_rgtc"};
    case TextureFormat::kBc7:
    case TextureFormat::kBc7Srgb:
      break;  // made linear in the shader, like all colours
  }
  return {GL_COMPRESSED_RGBA_BPTC_UNORM_EXT, GL_RGBA8, GL_RGBA, "GL_EXT_texture_compression_bptc"};
}

GLint LevelsOf(int side_px) {
  GLint levels = 1;
  while (side_px >> levels > 0) ++levels;
  return levels;
}

bool ReadsBlocks(TextureFormat format, const AtlasFormats& formats) {
  return FormatOf(format).internal == GL_RGBA8 ? formats.bc7_blocks : formats.rgtc_blocks;
}

// From mip level `first` on, or the last one before that is there.
AtlasPicture Prepare(const PackTexture& picture, size_t first, const AtlasFormats& formats) {
  first = std::min(first, picture.levels.size() - 1);
  AtlasPicture out{picture.format,
                   std::max(1, picture.width_px >> first),
                   std::max(1, picture.height_px >> first),
                   ReadsBlocks(picture.format, formats),
                   {}};
  const size_t end = std::min(picture.levels.size(), first + kImpostorMaxLevel + 1);
  for (size_t k = first; k < end; ++k) {
    const std::vector<uint8_t>& blocks = picture.levels[k];
    const int width_px = std::max(1, picture.width_px >> k), height_px = std::max(1, picture.height_px >> k);
    out.levels.push_back(out.blocks ? blocks : DecodeLevel(picture.format, width_px, height_px, blocks));
  }
  return out;
}

// Decoded depth in red, motion in green and blue; its bend is left out.
AtlasPicture Packed(const AtlasPicture& depth, const AtlasPicture& motion) {
  AtlasPicture out{TextureFormat::kBc7Srgb, depth.width_px, depth.height_px, false, {}};
  const auto side = [](int px, size_t level) { return static_cast<size_t>(std::max(1, px >> level)); };
  for (size_t level = 0; level < std::min(depth.levels.size(), motion.levels.size()); ++level) {
    const size_t width = side(out.width_px, level), height = side(out.height_px, level);
    const size_t motion_width = side(motion.width_px, level), motion_height = side(motion.height_px, level);
    std::vector<uint8_t>& texels = out.levels.emplace_back(width * height * 4);
    for (size_t y = 0; y < height; ++y) {
      for (size_t x = 0; x < width; ++x) {
        const uint8_t* moved =
            &motion.levels[level][4 * (y * motion_height / height * motion_width + x * motion_width / width)];
        uint8_t* to = &texels[4 * (y * width + x)];
        to[0] = depth.levels[level][y * width + x], to[1] = moved[0], to[2] = moved[1];
      }
    }
  }
  return out;
}

}  // namespace

std::vector<GLuint> CreateTextureArrays(const SurfacePlan& plan, bool fast) {
  std::vector<GLuint> textures(plan.arrays.size());
  glGenTextures(static_cast<GLsizei>(textures.size()), textures.data());
  for (size_t k = 0; k < textures.size(); ++k) {
    const TextureArrayPlan& a = plan.arrays[k];
    glBindTexture(GL_TEXTURE_2D_ARRAY, textures[k]);
    glTexStorage3D(GL_TEXTURE_2D_ARRAY, LevelsOf(a.side_px), a.blocks ? GL_COMPRESSED_RGB_S3TC_DXT1_EXT : GL_RGBA8,
                   a.side_px, a.side_px, std::max(1, a.layers));
    SetFilters(GL_TEXTURE_2D_ARRAY, GL_REPEAT, LevelsOf(a.side_px) - 1, !fast);
    // In software each anisotropic look-up walks an ellipse of texels: too expensive for many pictures a second.
    if (!fast && HasExtension("texture_filter_anisotropic")) {
      glTexParameterf(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_ANISOTROPY_EXT, 4);
    }
  }
  return textures;
}

void UploadLayer(GLuint texture, const TextureArrayPlan& array, int layer,
                 const std::vector<std::vector<uint8_t>>& levels) {
  glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  for (size_t k = 0; k < levels.size(); ++k) {
    const GLsizei side = std::max(1, array.side_px >> k);
    const auto level = static_cast<GLint>(k);
    const std::vector<uint8_t>& bytes = levels[k];
    if (array.blocks) {
      glCompressedTexSubImage3D(GL_TEXTURE_2D_ARRAY, level, 0, 0, layer, side, side, 1, GL_COMPRESSED_RGB_S3TC_DXT1_EXT,
                                static_cast<GLsizei>(bytes.size()), bytes.data());
    } else {
      glTexSubImage3D(GL_TEXTURE_2D_ARRAY, level, 0, 0, layer, side, side, 1, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
    }
  }
}

bool ReadsBc1() {
  return HasExtension("texture_compression_s3tc") || HasExtension("GL_EXT_texture_compression_dxt1") ||
         HasExtension("WEBGL_compressed_texture_s3tc");
}

AtlasFormats FormatsOfThisMachine(bool fast) {
  if (DrawsInSoftware()) return {false, false, fast};
  return {HasExtension(FormatOf(TextureFormat::kBc7Srgb).extension),
          HasExtension(FormatOf(TextureFormat::kBc5).extension), false};
}

std::array<AtlasPicture, kAtlasPictures> PrepareAtlas(const PackImpostor& atlas, const AtlasFormats& formats) {
  const bool pack = formats.pack_details;
  std::array<AtlasPicture, kAtlasPictures> out{
      Prepare(atlas.albedo, 0, formats), Prepare(atlas.normal, pack ? 1 : 0, formats),
      Prepare(atlas.depth, pack ? 1 : 0, formats), Prepare(atlas.motion, 0, formats),
      atlas.tints.levels.empty() ? AtlasPicture{} : Prepare(atlas.tints, 0, formats)};
  if (pack) {
    out[2] = Packed(out[2], out[3]);
    out[3] = {};
  }
  return out;
}

GLuint UploadAtlasPicture(const AtlasPicture& picture) {
  GLuint texture = 0;
  if (picture.levels.empty()) return texture;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  const BlockFormat f = FormatOf(picture.format);
  glTexStorage2D(GL_TEXTURE_2D, static_cast<GLsizei>(picture.levels.size()), picture.blocks ? f.compressed : f.internal,
                 picture.width_px, picture.height_px);
  for (size_t k = 0; k < picture.levels.size(); ++k) {
    const GLsizei width = std::max(1, picture.width_px >> k), height = std::max(1, picture.height_px >> k);
    const auto level = static_cast<GLint>(k);
    const std::vector<uint8_t>& bytes = picture.levels[k];
    if (picture.blocks) {
      glCompressedTexSubImage2D(GL_TEXTURE_2D, level, 0, 0, width, height, f.compressed,
                                static_cast<GLsizei>(bytes.size()), bytes.data());
    } else {
      glTexSubImage2D(GL_TEXTURE_2D, level, 0, 0, width, height, f.format, GL_UNSIGNED_BYTE, bytes.data());
    }
  }
  SetFilters(GL_TEXTURE_2D, GL_CLAMP_TO_EDGE, static_cast<GLint>(picture.levels.size()) - 1, true);
  return texture;
}

}  // namespace flaneur
