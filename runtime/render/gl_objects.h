// Small helpers over OpenGL names. Internal to runtime/render.
#pragma once
#include <GLES3/gl3.h>

#include <string>

#include "runtime/base/error.h"
#include "runtime/base/math.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {

Error BuildProgram(const std::string& vertex, const std::string& fragment, GLuint* program);
void SetUniform(GLuint program, const char* name, const Mat4& value);
void SetUniform(GLuint program, const char* name, Vec3 value);
void SetUniform(GLuint program, const char* name, Vec4 value);
void SetUniform(GLuint program, const char* name, float value);
void SetUniform(GLuint program, const char* name, int value);

// True where no GPU draws: then detail that a GPU gives away is too dear.
bool DrawsInSoftware();

// Mipmapped; `repeat` else clamped; `most_level` limits how small mips get used.
GLuint UploadTexture(const PackImage& image, bool srgb, bool repeat, int most_level);
GLuint UploadWhite();

struct ShadowMap { GLuint texture = 0, framebuffer = 0; int size_px = 0; };
ShadowMap CreateShadowMap(int size_px);

// A multisampled picture and its resolved copy, remade when the size changes.
struct Picture {
  int width_px = 0, height_px = 0, samples = 0;
  GLuint color = 0, depth = 0, framebuffer = 0, resolved_color = 0, resolved = 0;
};
void ResizePicture(int width_px, int height_px, Picture* picture);
void ResolvePicture(const Picture& picture);

}  // namespace flaneur
