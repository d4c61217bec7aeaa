#include "runtime/render/textures.h"

#include <GLES2/gl2ext.h>

#include <algorithm>
#include <cstring>

#include "runtime/base/parallel.h"
#include "runtime/render/gl_objects.h"
#include "runtime/render/mip_chain.h"

namespace flaneur {
namespace {

constexpr int kMostLevel = 16;
constexpr int kImpostorMostLevel = 3;  // in coarser ones several cells share a texel

void UploadLevel(int level, const PackImage& image) {
  glTexImage2D(GL_TEXTURE_2D, level, GL_RGBA8, image.width_px, image.height_px, 0, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
}

void SetFilters(GLint wrap, GLint most_level) {
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, most_level);
}

bool HasExtension(const char* name) {
  const auto* extensions = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
  return extensions != nullptr && std::strstr(extensions, name) != nullptr;
}

GLuint UploadTexture(const PackImage& image, const std::vector<PackImage>& smaller) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  UploadLevel(0, image);
  for (size_t k = 0; k < smaller.size(); ++k) UploadLevel(static_cast<int>(k) + 1, smaller[k]);
  SetFilters(GL_REPEAT, static_cast<GLint>(smaller.size()));
  // In software each anisotropic look-up walks an ellipse of texels: ten times the whole rest of a frame.
  if (!DrawsInSoftware() && HasExtension("texture_filter_anisotropic")) {
    glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_MAX_ANISOTROPY_EXT, 4);
  }
  return texture;
}

struct BlockFormat { GLenum compressed, internal, format; const char* extension; };

BlockFormat FormatOf(TextureFormat format) {
  switch (format) {
    case TextureFormat::kBc4: return {GL_COMPRESSED_RED_RGTC1_EXT, GL_R8, GL_RED, "GL_EXT_texture_compression_rgtc"};
    case TextureFormat::kBc5: return {GL_COMPRESSED_RED_GREEN_RGTC2_EXT, GL_RG8, GL_RG, "GL_EXT_texture_compression_rgtc"};
    case TextureFormat::kBc7Srgb: break;  // made linear in the shader, like all colours
  }
  return {GL_COMPRESSED_RGBA_BPTC_UNORM_EXT, GL_RGBA8, GL_RGBA, "GL_EXT_texture_compression_bptc"};
}

}  // namespace

std::vector<GLuint> UploadTextures(const TourPack& pack) {
  std::vector<std::vector<PackImage>> smaller(pack.images.size());
  ParallelFor(pack.images.size(), [&](size_t i) { smaller[i] = MakeMipChain(pack.images[i], true, kMostLevel); });
  std::vector<GLuint> textures;
  for (size_t i = 0; i < pack.images.size(); ++i) textures.push_back(UploadTexture(pack.images[i], smaller[i]));
  return textures;
}

GLuint UploadWhite() { return UploadTexture({1, 1, {255, 255, 255, 255}}, {}); }

GLuint UploadAtlasPicture(const PackTexture& picture, bool decode) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  const BlockFormat f = FormatOf(picture.format);
  const bool blocks = !decode && HasExtension(f.extension);
  const size_t levels = std::min(picture.levels.size(), size_t{kImpostorMostLevel} + 1);
  std::vector<std::vector<uint8_t>> texels(levels);
  if (!blocks) {
    ParallelFor(levels, [&](size_t k) {
      texels[k] = DecodeLevel(picture.format, std::max(1, picture.width_px >> k), std::max(1, picture.height_px >> k), picture.levels[k]);
    });
  }
  for (size_t k = 0; k < levels; ++k) {
    const GLsizei width = std::max(1, picture.width_px >> k), height = std::max(1, picture.height_px >> k);
    const auto level = static_cast<GLint>(k);
    if (blocks) {
      glCompressedTexImage2D(GL_TEXTURE_2D, level, f.compressed, width, height, 0, static_cast<GLsizei>(picture.levels[k].size()),
                             picture.levels[k].data());
    } else {
      glTexImage2D(GL_TEXTURE_2D, level, static_cast<GLint>(f.internal), width, height, 0, f.format, GL_UNSIGNED_BYTE, texels[k].data());
    }
  }
  SetFilters(GL_CLAMP_TO_EDGE, static_cast<GLint>(levels) - 1);
  return texture;
}

std::vector<Surface> MakeSurfaces(const TourPack& pack, const std::vector<GLuint>& textures) {
  const GLuint white = UploadWhite();
  std::vector<Surface> surfaces;
  for (const PackMaterial& m : pack.materials) {
    surfaces.push_back({m.base_color_image >= 0 ? textures[static_cast<size_t>(m.base_color_image)] : white, m.alpha_cutoff,
                        m.alpha_mask, m.double_sided});
  }
  surfaces.push_back({white, 0, false, false});
  return surfaces;
}

}  // namespace flaneur
