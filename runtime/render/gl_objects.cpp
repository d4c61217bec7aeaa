#include "runtime/render/gl_objects.h"

#include <algorithm>
#include <cstring>

#include "runtime/base/text.h"
#include "runtime/render/all_shaders.h"
#include "runtime/render/shaders.h"

namespace flaneur {
namespace {

constexpr GLuint kFrameBinding = 0;

bool keeps_sources = false;
std::vector<ShaderSource> kept_sources;

Error Compile(GLenum kind, const std::string& source, GLuint* shader) {
  *shader = glCreateShader(kind);
  const std::string whole = kHeader + source;
  if (keeps_sources) kept_sources.push_back({kind == GL_VERTEX_SHADER, whole});
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

void NamePlaces(GLuint program) {
  glUseProgram(program);
  const GLuint block = glGetUniformBlockIndex(program, "Frame");
  if (block != GL_INVALID_INDEX) glUniformBlockBinding(program, block, kFrameBinding);
  const struct { const char* name; TextureUnit unit; } samplers[] = {
      {"u_texture", kColorUnit}, {"u_normals", kNormalsUnit}, {"u_depth", kDepthUnit}, {"u_motion", kMotionUnit}, {"u_poses", kPosesUnit},
      {"u_town_shadow_map", kTownShadowUnit}, {"u_people_shadow_map", kPeopleShadowUnit},
      {"u_textures", kArrayUnit}, {"u_cells", kCellsUnit}};
  for (const auto& s : samplers) glUniform1i(glGetUniformLocation(program, s.name), s.unit);
}

}  // namespace

void KeepShaderSources(bool on) { keeps_sources = on; }
const std::vector<ShaderSource>& KeptShaderSources() { return kept_sources; }

Error BuildProgram(const std::string& vertex, const std::string& fragment, GLuint* program) {
  GLuint v = 0, f = 0;
  if (Error e = Compile(GL_VERTEX_SHADER, vertex, &v)) return e;
  if (Error e = Compile(GL_FRAGMENT_SHADER, fragment, &f)) return e;
  *program = glCreateProgram();
  glAttachShader(*program, v);
  glAttachShader(*program, f);
  glLinkProgram(*program);
  for (GLuint shader : {v, f}) {  // drivers keep what they made of it as long as it is attached
    glDetachShader(*program, shader);
    glDeleteShader(shader);
  }
  GLint good = 0;
  glGetProgramiv(*program, GL_LINK_STATUS, &good);
  if (good) {
    NamePlaces(*program);
    return Ok();
  }
  char log[1024] = "";
  glGetProgramInfoLog(*program, sizeof log, nullptr, log);
  return Fail("the OpenGL driver refuses a shader program: " + OneLine(log));
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
void SetUniform(GLuint program, const char* name, std::span<const Vec4> values) {
  glUniform4fv(glGetUniformLocation(program, name), static_cast<GLsizei>(values.size()), &values[0].x);
}

void BindFrameBlock(GLuint buffer, const FrameBlock& block) {
  glBindBuffer(GL_UNIFORM_BUFFER, buffer);
  glBufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_STREAM_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, kFrameBinding, buffer);
}

bool DrawsInSoftware() {
  const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return renderer != nullptr && (std::strstr(renderer, "llvmpipe") != nullptr || std::strstr(renderer, "softpipe") != nullptr ||
                                 std::strstr(renderer, "SwiftShader") != nullptr);
}

GLuint CreateBuffer(GLenum target, const void* data, size_t bytes) {
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(target, buffer);
  glBufferData(target, static_cast<GLsizeiptr>(bytes), data, GL_STATIC_DRAW);
  return buffer;
}

void EnableAttribute(GLuint index, GLint size, GLenum type, bool normalized, size_t stride, size_t offset, GLuint divisor) {
  glEnableVertexAttribArray(index);
  const void* pointer = reinterpret_cast<const void*>(offset);
  if (type == GL_FLOAT || normalized) glVertexAttribPointer(index, size, type, normalized, static_cast<GLsizei>(stride), pointer);
  else glVertexAttribIPointer(index, size, type, static_cast<GLsizei>(stride), pointer);
  glVertexAttribDivisor(index, divisor);
}

void BindTexture(TextureUnit unit, GLuint texture) {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, texture);
}

void BindTextureArray(TextureUnit unit, GLuint texture) {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
}

void CullBackFaces(bool cull) {
  if (cull) glEnable(GL_CULL_FACE);
  else glDisable(GL_CULL_FACE);
}

}  // namespace flaneur
