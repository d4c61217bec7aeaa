#include "runtime/render/textures.h"

#include <GLES2/gl2ext.h>

#include <algorithm>
#include <cstring>

#include "runtime/render/gl_objects.h"

namespace flaneur {
namespace {

// In software only pictures larger than this are mixed between mip levels: those are walls' and the ground's, where one
// sees from afar where the levels change.
constexpr int kMixed_px = 512;

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
  GLenum own_blocks, etc2_blocks, internal, format;
  const char* extension;
};

BlockFormat FormatOf(TextureFormat format) {
  switch (format) {
    case TextureFormat::kBc4:
      return {GL_COMPRESSED_RED_RGTC1_EXT, GL_COMPRESSED_R11_EAC, GL_R8, GL_RED, "GL_EXT_texture_compression_rgtc"};
    case TextureFormat::kBc5:
      return {GL_COMPRESSED_RED_GREEN_RGTC2_EXT, GL_COMPRESSED_RG11_EAC, GL_RG8, GL_RG,
              "GL_EXT_texture_compression_rgtc"};
    case TextureFormat::kBc7:
    case TextureFormat::kBc7Srgb:
      break;  // made linear in the shader, like all colours
  }
  return {GL_COMPRESSED_RGBA_BPTC_UNORM_EXT, GL_COMPRESSED_RGBA8_ETC2_EAC, GL_RGBA8, GL_RGBA,
          "GL_EXT_texture_compression_bptc"};
}

#ifdef __EMSCRIPTEN__
constexpr bool kIsWebGl = true;
#else
constexpr bool kIsWebGl = false;
#endif

// Every OpenGL ES 3 does; a page's says whether the card does itself.
bool ReadsEtc2() { return !kIsWebGl || HasExtension("WEBGL_compressed_texture_etc"); }

GLint LevelsOf(int side_px) {
  GLint levels = 1;
  while (side_px >> levels > 0) ++levels;
  return levels;
}

GLenum StorageOf(const AtlasPicture& picture) {
  const BlockFormat f = FormatOf(picture.format);
  if (picture.stored_as == StoredAs::kTexels) return f.internal;
  return picture.stored_as == StoredAs::kOwnBlocks ? f.own_blocks : f.etc2_blocks;
}

GLuint CreateAtlasTexture(const AtlasPicture& picture) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  const auto levels = static_cast<GLsizei>(picture.levels.size());
  glTexStorage2D(GL_TEXTURE_2D, levels, StorageOf(picture), picture.width_px, picture.height_px);
  SetFilters(GL_TEXTURE_2D, GL_CLAMP_TO_EDGE, levels - 1, true);
  return texture;
}

// Rows of blocks or of texels of a level.
struct Rows {
  int first_px = 0, count_px = 0;
  const uint8_t* from = nullptr;
  size_t bytes = 0;
};

// Those that come next of a level, about so many bytes of it but one row at least; goes on behind them.
Rows TakeRows(const std::vector<uint8_t>& level, int height_px, bool blocks, size_t most_bytes, UploadPlace* next) {
  const int unit_px = blocks ? 4 : 1, units = (height_px + unit_px - 1) / unit_px, first = next->row_px / unit_px;
  const size_t unit_bytes = level.size() / static_cast<size_t>(units);
  const int count =
      static_cast<int>(std::clamp<size_t>(most_bytes / unit_bytes, 1, static_cast<size_t>(units - first)));
  const Rows rows{next->row_px, std::min(height_px, (first + count) * unit_px) - next->row_px,
                  level.data() + static_cast<size_t>(first) * unit_bytes, static_cast<size_t>(count) * unit_bytes};
  next->row_px += rows.count_px;
  if (next->row_px == height_px) next->row_px = 0, ++next->level;
  return rows;
}

size_t UploadRows(GLuint texture, const AtlasPicture& picture, size_t most_bytes, UploadPlace* next) {
  const auto level = static_cast<GLint>(next->level);
  const int width_px = std::max(1, picture.width_px >> level), height_px = std::max(1, picture.height_px >> level);
  const bool blocks = picture.stored_as != StoredAs::kTexels;
  const Rows rows = TakeRows(picture.levels[next->level], height_px, blocks, most_bytes, next);
  glBindTexture(GL_TEXTURE_2D, texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  if (blocks) {
    glCompressedTexSubImage2D(GL_TEXTURE_2D, level, 0, rows.first_px, width_px, rows.count_px, StorageOf(picture),
                              static_cast<GLsizei>(rows.bytes), rows.from);
  } else {
    glTexSubImage2D(GL_TEXTURE_2D, level, 0, rows.first_px, width_px, rows.count_px, FormatOf(picture.format).format,
                    GL_UNSIGNED_BYTE, rows.from);
  }
  return rows.bytes;
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
    SetFilters(GL_TEXTURE_2D_ARRAY, GL_REPEAT, LevelsOf(a.side_px) - 1, !fast || a.side_px > kMixed_px);
    // In software each anisotropic look-up walks an ellipse of texels: too expensive for many pictures a second.
    if (!fast && HasExtension("texture_filter_anisotropic")) {
      glTexParameterf(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_ANISOTROPY_EXT, 4);
    }
  }
  return textures;
}

bool UploadLayer(size_t most_bytes, GLuint texture, const TextureArrayPlan& array, int layer,
                 const std::vector<std::vector<uint8_t>>& levels, UploadPlace* next) {
  glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  for (size_t sent = 0; next->level < levels.size() && sent < most_bytes;) {
    const auto level = static_cast<GLint>(next->level);
    const GLsizei side_px = std::max(1, array.side_px >> level);
    const Rows rows = TakeRows(levels[next->level], side_px, array.blocks, most_bytes - sent, next);
    if (array.blocks) {
      glCompressedTexSubImage3D(GL_TEXTURE_2D_ARRAY, level, 0, rows.first_px, layer, side_px, rows.count_px, 1,
                                GL_COMPRESSED_RGB_S3TC_DXT1_EXT, static_cast<GLsizei>(rows.bytes), rows.from);
    } else {
      glTexSubImage3D(GL_TEXTURE_2D_ARRAY, level, 0, rows.first_px, layer, side_px, rows.count_px, 1, GL_RGBA,
                      GL_UNSIGNED_BYTE, rows.from);
    }
    sent += rows.bytes;
  }
  return next->level == levels.size();
}

bool ReadsBc1() {
  return HasExtension("texture_compression_s3tc") || HasExtension("GL_EXT_texture_compression_dxt1") ||
         HasExtension("WEBGL_compressed_texture_s3tc");
}

AtlasFormats FormatsOfThisMachine(bool fast) {
  AtlasFormats formats;
  if (DrawsInSoftware()) {
    formats.pack_details = fast;
    return formats;
  }
  formats.bc7_blocks = HasExtension(FormatOf(TextureFormat::kBc7Srgb).extension);
  formats.rgtc_blocks = HasExtension(FormatOf(TextureFormat::kBc5).extension);
  formats.etc2_blocks = ReadsEtc2();
  formats.whole_blocks = kIsWebGl;
  formats.fewer_texels = !formats.bc7_blocks && !formats.etc2_blocks;
  return formats;
}

bool UploadAtlas(size_t most_bytes, const std::array<AtlasPicture, kAtlasPictures>& pictures, AtlasUpload* upload) {
  AtlasUpload& u = *upload;
  const auto skip = [&] {
    while (u.picture < pictures.size() && u.next.level == pictures[u.picture].levels.size()) ++u.picture, u.next = {};
    return u.picture == pictures.size();
  };
  for (size_t sent = 0; !skip() && sent < most_bytes;) {
    const AtlasPicture& picture = pictures[u.picture];
    GLuint& texture = u.textures[u.picture];
    if (texture == 0) texture = CreateAtlasTexture(picture);
    sent += UploadRows(texture, picture, most_bytes - sent, &u.next);
  }
  return skip();
}

}  // namespace flaneur
