#include "runtime/render/gl_objects.h"

#include <GLES2/gl2ext.h>

#include <algorithm>
#include <cstring>

#include "runtime/base/text.h"
#include "runtime/render/shaders.h"

namespace flaneur {
namespace {

constexpr int kSamples = 4;

Error Compile(GLenum kind, const std::string& source, GLuint* shader) {
  *shader = glCreateShader(kind);
  const std::string whole = kHeader + source;
  const char* text = whole.c_str();
  glShaderSource(*shader, 1, &text, nullptr);
  glCompileShader(*shader);
  GLint good = 0;
  glGetShaderiv(*shader, GL_COMPILE_STATUS, &good);
  if (good) return Ok();
  char log[1024] = "";
  glGetShaderInfoLog(*shader, sizeof log, nullptr, log);
  return Fail("the OpenGL driver refuses a shader: " + OneLine(log));
}

}  // namespace

Error BuildProgram(const std::string& vertex, const std::string& fragment, GLuint* program) {
  GLuint v = 0, f = 0;
  if (Error e = Compile(GL_VERTEX_SHADER, vertex, &v)) return e;
  if (Error e = Compile(GL_FRAGMENT_SHADER, fragment, &f)) return e;
  *program = glCreateProgram();
  glAttachShader(*program, v);
  glAttachShader(*program, f);
  glLinkProgram(*program);
  glDeleteShader(v);
  glDeleteShader(f);
  GLint good = 0;
  glGetProgramiv(*program, GL_LINK_STATUS, &good);
  if (good) return Ok();
  char log[1024] = "";
  glGetProgramInfoLog(*program, sizeof log, nullptr, log);
  return Fail("the OpenGL driver refuses a shader program: " + OneLine(log));
}

void SetUniform(GLuint program, const char* name, const Mat4& value) {
  glUniformMatrix4fv(glGetUniformLocation(program, name), 1, GL_FALSE, &value.m[0][0]);
}
void SetUniform(GLuint program, const char* name, Vec3 v) {
  glUniform3f(glGetUniformLocation(program, name), v.x, v.y, v.z);
}
void SetUniform(GLuint program, const char* name, Vec4 v) {
  glUniform4f(glGetUniformLocation(program, name), v.x, v.y, v.z, v.w);
}
void SetUniform(GLuint program, const char* name, float value) {
  glUniform1f(glGetUniformLocation(program, name), value);
}
void SetUniform(GLuint program, const char* name, int value) {
  glUniform1i(glGetUniformLocation(program, name), value);
}

bool DrawsInSoftware() {
  const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return renderer != nullptr && (std::strstr(renderer, "llvmpipe") != nullptr || std::strstr(renderer, "softpipe") != nullptr ||
                                 std::strstr(renderer, "SwiftShader") != nullptr);
}

GLuint UploadTexture(const PackImage& image, bool srgb, bool repeat, int most_level) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, image.width_px, image.height_px, 0,
               GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  const GLint wrap = repeat ? GL_REPEAT : GL_CLAMP_TO_EDGE;
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, most_level);
  const auto* extensions = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
  // In software each anisotropic look-up walks an ellipse of texels: ten times the whole rest of a frame.
  if (!DrawsInSoftware() && extensions != nullptr && std::strstr(extensions, "texture_filter_anisotropic") != nullptr) {
    glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_MAX_ANISOTROPY_EXT, 4);
  }
  return texture;
}

GLuint UploadWhite() { return UploadTexture({1, 1, {255, 255, 255, 255}}, false, true, 0); }

ShadowMap CreateShadowMap(int size_px) {
  ShadowMap map;
  map.size_px = size_px;
  glGenTextures(1, &map.texture);
  glBindTexture(GL_TEXTURE_2D, map.texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, size_px, size_px, 0, GL_DEPTH_COMPONENT,
               GL_UNSIGNED_INT, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glGenFramebuffers(1, &map.framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, map.framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, map.texture, 0);
  const GLenum none = GL_NONE;
  glDrawBuffers(1, &none);
  return map;
}

void ResizePicture(int width_px, int height_px, Picture* p) {
  if (p->width_px == width_px && p->height_px == height_px) return;
  if (p->framebuffer == 0) {
    glGenRenderbuffers(1, &p->color);
    glGenRenderbuffers(1, &p->depth);
    glGenRenderbuffers(1, &p->resolved_color);
    glGenFramebuffers(1, &p->framebuffer);
    glGenFramebuffers(1, &p->resolved);
  }
  GLint most = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  p->width_px = width_px;
  p->height_px = height_px;
  p->samples = std::min<int>(most, kSamples);
  glBindRenderbuffer(GL_RENDERBUFFER, p->color);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, p->samples, GL_RGBA8, width_px, height_px);
  glBindRenderbuffer(GL_RENDERBUFFER, p->depth);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, p->samples, GL_DEPTH_COMPONENT24, width_px, height_px);
  glBindRenderbuffer(GL_RENDERBUFFER, p->resolved_color);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width_px, height_px);
  glBindFramebuffer(GL_FRAMEBUFFER, p->framebuffer);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, p->color);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, p->depth);
  glBindFramebuffer(GL_FRAMEBUFFER, p->resolved);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, p->resolved_color);
}

void ResolvePicture(const Picture& p) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, p.framebuffer);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, p.resolved);
  glBlitFramebuffer(0, 0, p.width_px, p.height_px, 0, 0, p.width_px, p.height_px, GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
}

}  // namespace flaneur
