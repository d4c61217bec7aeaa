#include "runtime/render/textures.h"

#include <GLES2/gl2ext.h>

#include <cstring>

#include "runtime/base/parallel.h"
#include "runtime/render/gl_objects.h"
#include "runtime/render/mip_chain.h"

namespace flaneur {
namespace {

constexpr int kImpostorMostLevel = 3, kSurfaceMostLevel = 16;

enum class ImageUse { kSurface, kImpostorColor, kImpostorNormals };

std::vector<ImageUse> UsesOf(const TourPack& pack) {
  std::vector<ImageUse> uses(pack.images.size(), ImageUse::kSurface);
  for (const PackAvatar& a : pack.avatars) {
    uses[static_cast<size_t>(a.impostor.albedo_image)] = ImageUse::kImpostorColor;
    uses[static_cast<size_t>(a.impostor.normal_image)] = ImageUse::kImpostorNormals;
  }
  return uses;
}

void UploadLevel(int level, const PackImage& image) {
  glTexImage2D(GL_TEXTURE_2D, level, GL_RGBA8, image.width_px, image.height_px, 0, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
}

GLuint UploadTexture(const PackImage& image, const std::vector<PackImage>& smaller, bool repeat) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  UploadLevel(0, image);
  for (size_t k = 0; k < smaller.size(); ++k) UploadLevel(static_cast<int>(k) + 1, smaller[k]);
  const GLint wrap = repeat ? GL_REPEAT : GL_CLAMP_TO_EDGE;
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, static_cast<GLint>(smaller.size()));
  const auto* extensions = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
  // In software each anisotropic look-up walks an ellipse of texels: ten times the whole rest of a frame.
  if (!DrawsInSoftware() && extensions != nullptr && std::strstr(extensions, "texture_filter_anisotropic") != nullptr) {
    glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_MAX_ANISOTROPY_EXT, 4);
  }
  return texture;
}

}  // namespace

std::vector<GLuint> UploadTextures(const TourPack& pack) {
  const std::vector<ImageUse> uses = UsesOf(pack);
  std::vector<std::vector<PackImage>> smaller(pack.images.size());
  ParallelFor(pack.images.size(), [&](size_t i) {
    smaller[i] = MakeMipChain(pack.images[i], uses[i] != ImageUse::kImpostorNormals,
                              uses[i] == ImageUse::kSurface ? kSurfaceMostLevel : kImpostorMostLevel);
  });
  std::vector<GLuint> textures;
  for (size_t i = 0; i < pack.images.size(); ++i) {
    textures.push_back(UploadTexture(pack.images[i], smaller[i], uses[i] == ImageUse::kSurface));
  }
  return textures;
}

GLuint UploadWhite() { return UploadTexture({1, 1, {255, 255, 255, 255}}, {}, true); }

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
