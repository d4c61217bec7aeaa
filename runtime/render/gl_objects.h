// Small helpers over OpenGL names. Internal to runtime/render. All objects live as long as their context.
#pragma once
#include <GLES3/gl3.h>

#include <cstddef>
#include <span>

#include "runtime/base/error.h"
#include "runtime/base/math.h"
#include "runtime/render/shaders/programs.h"
#include "runtime/render/shaders/shared.glsl"

namespace flaneur {

// Places that all programs share: sampler uniforms get their unit, the block Frame its binding, at linking.
enum TextureUnit {
  kColorUnit,
  kNormalsUnit,
  kDepthUnit,
  kMotionUnit,
  kPosesUnit,
  kTownShadowUnit,
  kPeopleShadowUnit,
  kArrayUnit,
  kCellsUnit,
  kTintsUnit
};

// The uniform block Frame of the shaders.
struct FrameBlock {
  using mat4 = Mat4;
  using vec4 = Vec4;
#define FIELD(type, name) type name;
#include "runtime/render/shaders/frame_fields.glsl"
#undef FIELD
};
void BindFrameBlock(GLuint buffer, const FrameBlock& block);

// A program of the driver's, and the places of the uniforms that it has.
struct Program {
  GLuint id = 0;
  GLint atlas = -1, ranges = -1, directions = -1, tints = -1, tint_shifts = -1, tint_regions = -1;
  GLint alpha_cutoff = -1, share = -1, size = -1;
};
// Drivers may compile on other threads until somebody asks how it went: many programs of the context in force are begun
// at once, and BuildProgram goes on with those.
void BeginProgram(ShaderProgram which, ShaderMode mode = ShaderMode::kGpu);
// Until all that have begun are compiled, and not until whatever else the driver has been asked for afterwards.
void AwaitBegunPrograms();
// Errors: what the driver says against it.
Error BuildProgram(ShaderProgram which, ShaderMode mode, Program* program);
Error BuildProgram(ShaderProgram which, Program* program);  // where all modes are alike
// Of the program in use; place: a Program's.
void SetUniform(GLint place, Vec3 value);
void SetUniform(GLint place, Vec4 value);
void SetUniform(GLint place, float value);
void SetUniform(GLint place, std::span<const Vec4> values);  // an array of the shader's

// What draws have taken.
struct DrawCost {
  int64_t triangles = 0;
  int calls = 0;
  void operator+=(const DrawCost& other) { triangles += other.triangles, calls += other.calls; }
};

// True where no GPU draws: then what a GPU gives away is too expensive.
bool DrawsInSoftware();

GLuint CreateBuffer(GLenum target, const void* data, size_t bytes);
// `divisor` 1: of an instance. Integers stay integers unless `normalized`.
void EnableAttribute(GLuint index, GLint size, GLenum type, bool normalized, size_t stride, size_t offset,
                     GLuint divisor);
void BindTexture(TextureUnit unit, GLuint texture);
void BindTextureArray(TextureUnit unit, GLuint texture);
void CullBackFaces(bool cull);

}  // namespace flaneur
