// Small helpers over OpenGL names. Internal to runtime/render. All objects live as long as their context.
#pragma once
#include <GLES3/gl3.h>

#include <cstddef>
#include <span>
#include <string>

#include "runtime/base/error.h"
#include "runtime/base/math.h"

namespace flaneur {

// Places that all programs share: sampler uniforms get their unit, the block Frame its binding, at linking.
enum TextureUnit { kColorUnit, kNormalsUnit, kDepthUnit, kMotionUnit, kPosesUnit, kTownShadowUnit, kPeopleShadowUnit, kArrayUnit, kCellsUnit };

// The uniform block Frame of shaders.h, in its std140 layout.
struct FrameBlock {
  Mat4 view_projection, inverse_view_projection, near_shadow, far_shadow, people_shadow;
  Vec4 eye, to_sun, sun_color, sky_color, ground_color, haze_color, zenith_color, shadow_layers;
};
void BindFrameBlock(GLuint buffer, const FrameBlock& block);

// Both sources without the header. Errors: what the driver says against them.
Error BuildProgram(const std::string& vertex, const std::string& fragment, GLuint* program);
void SetUniform(GLuint program, const char* name, Vec3 value);
void SetUniform(GLuint program, const char* name, Vec4 value);
void SetUniform(GLuint program, const char* name, float value);
void SetUniform(GLuint program, const char* name, std::span<const Vec4> values);  // an array of the shader's

// What draws have taken.
struct DrawCost {
  int64_t triangles = 0;
  int calls = 0;
  void operator+=(const DrawCost& other) { triangles += other.triangles, calls += other.calls; }
};

// True where no GPU draws: then what a GPU gives away is too dear.
bool DrawsInSoftware();

GLuint CreateBuffer(GLenum target, const void* data, size_t bytes);
// `divisor` 1: of an instance. Integers stay integers unless `normalized`.
void EnableAttribute(GLuint index, GLint size, GLenum type, bool normalized, size_t stride, size_t offset, GLuint divisor);
void BindTexture(TextureUnit unit, GLuint texture);
void BindTextureArray(TextureUnit unit, GLuint texture);
void CullBackFaces(bool cull);

}  // namespace flaneur
