#include "runtime/render/gl_objects.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "runtime/base/text.h"
#include "runtime/render/shader_source.h"

namespace flaneur {
namespace {

constexpr GLuint kFrameBinding = 0;

struct BegunProgram {
  ShaderProgram which;
  ShaderMode mode;
  GLuint id = 0, vertex = 0, fragment = 0;
  bool asked = false;  // the rest is known; browsers ask the driver anew, and wait for it, where there is no block
  GLint good = 0;
  GLuint frame_block = GL_INVALID_INDEX;
};
std::vector<BegunProgram> begun;

auto FindBegun(ShaderProgram which, ShaderMode mode) {
  return std::find_if(begun.begin(), begun.end(),
                      [&](const BegunProgram& p) { return p.which == which && p.mode == mode; });
}

GLuint Compile(GLenum kind, const std::string& source) {
  const GLuint shader = glCreateShader(kind);
  const char* text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  return shader;
}

std::string WhyNot(GLuint program, GLuint vertex, GLuint fragment) {
  char log[1024] = "";
  for (const GLuint shader : {vertex, fragment}) {
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good) continue;
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    return "the OpenGL driver refuses a shader: " + OneLine(log);
  }
  glGetProgramInfoLog(program, sizeof log, nullptr, log);
  return "the OpenGL driver refuses a shader program: " + OneLine(log);
}

void Ask(BegunProgram* p) {
  if (p->asked) return;
  p->asked = true;
  glGetProgramiv(p->id, GL_LINK_STATUS, &p->good);
  if (p->good) p->frame_block = glGetUniformBlockIndex(p->id, "Frame");
}

void TakePlaces(GLuint block, Program* p) {
  const GLuint program = p->id;
  glUseProgram(program);
  if (block != GL_INVALID_INDEX) glUniformBlockBinding(program, block, kFrameBinding);
  const struct {
    const char* name;
    TextureUnit unit;
  } samplers[] = {{"u_texture", kColorUnit},
                  {"u_normals", kNormalsUnit},
                  {"u_depth", kDepthUnit},
                  {"u_motion", kMotionUnit},
                  {"u_poses", kPosesUnit},
                  {"u_town_shadow_map", kTownShadowUnit},
                  {"u_people_shadow_map", kPeopleShadowUnit},
                  {"u_textures", kArrayUnit},
                  {"u_cells", kCellsUnit},
                  {"u_tint_picture", kTintsUnit}};
  for (const auto& s : samplers) glUniform1i(glGetUniformLocation(program, s.name), s.unit);
  const struct {
    const char* name;
    GLint* place;
  } uniforms[] = {{"u_atlas", &p->atlas},
                  {"u_ranges", &p->ranges},
                  {"u_directions", &p->directions},
                  {"u_tints", &p->tints},
                  {"u_tint_shifts", &p->tint_shifts},
                  {"u_tint_regions", &p->tint_regions},
                  {"u_alpha_cutoff", &p->alpha_cutoff},
                  {"u_share", &p->share},
                  {"u_size", &p->size}};
  for (const auto& u : uniforms) *u.place = glGetUniformLocation(program, u.name);
}

}  // namespace

void BeginProgram(ShaderProgram which, ShaderMode mode) {
  if (FindBegun(which, mode) != begun.end()) return;
  const ShaderSource source = SourceOf(which, mode);
  const BegunProgram p{which, mode, glCreateProgram(), Compile(GL_VERTEX_SHADER, source.vertex),
                       Compile(GL_FRAGMENT_SHADER, source.fragment)};
  glAttachShader(p.id, p.vertex);
  glAttachShader(p.id, p.fragment);
  glLinkProgram(p.id);
  begun.push_back(p);
}

void AwaitBegunPrograms() {
  for (BegunProgram& p : begun) Ask(&p);
}

Error BuildProgram(ShaderProgram which, ShaderMode mode, Program* program) {
  BeginProgram(which, mode);
  const auto place = FindBegun(which, mode);
  Ask(&*place);
  const BegunProgram p = *place;
  begun.erase(place);
  program->id = p.id;
  const std::string refusal = p.good ? "" : WhyNot(p.id, p.vertex, p.fragment);
  for (GLuint shader : {p.vertex, p.fragment}) {  // drivers keep what they made of it as long as it is attached
    glDetachShader(p.id, shader);
    glDeleteShader(shader);
  }
  if (!p.good) return Fail(refusal);
  TakePlaces(p.frame_block, program);
  return Ok();
}

Error BuildProgram(ShaderProgram which, Program* program) { return BuildProgram(which, ShaderMode::kGpu, program); }

void SetUniform(GLint place, Vec3 v) { glUniform3f(place, v.x, v.y, v.z); }
void SetUniform(GLint place, Vec4 v) { glUniform4f(place, v.x, v.y, v.z, v.w); }
void SetUniform(GLint place, float value) { glUniform1f(place, value); }
void SetUniform(GLint place, std::span<const Vec4> values) {
  glUniform4fv(place, static_cast<GLsizei>(values.size()), &values[0].x);
}

void BindFrameBlock(GLuint buffer, const FrameBlock& block) {
  glBindBuffer(GL_UNIFORM_BUFFER, buffer);
  glBufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_STREAM_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, kFrameBinding, buffer);
}

bool DrawsInSoftware() {
#ifdef __EMSCRIPTEN__  // browsers hide the usual name behind one of their own, unless the page has asked for it
  constexpr GLenum kRendererName = 0x9246;  // UNMASKED_RENDERER_WEBGL of WEBGL_debug_renderer_info
#else
  constexpr GLenum kRendererName = GL_RENDERER;
#endif
  const auto* renderer = reinterpret_cast<const char*>(glGetString(kRendererName));
  return renderer != nullptr &&
         (std::strstr(renderer, "llvmpipe") != nullptr || std::strstr(renderer, "softpipe") != nullptr ||
          std::strstr(renderer, "SwiftShader") != nullptr);
}

GLuint CreateBuffer(GLenum target, const void* data, size_t bytes) {
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(target, buffer);
  glBufferData(target, static_cast<GLsizeiptr>(bytes), data, GL_STATIC_DRAW);
  return buffer;
}

void EnableAttribute(GLuint index, GLint size, GLenum type, bool normalized, size_t stride, size_t offset,
                     GLuint divisor) {
  glEnableVertexAttribArray(index);
  const void* pointer = reinterpret_cast<const void*>(offset);
  if (type == GL_FLOAT || normalized)
    glVertexAttribPointer(index, size, type, normalized, static_cast<GLsizei>(stride), pointer);
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
