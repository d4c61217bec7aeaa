#include "runtime/render/picture.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

GLuint NewTexture(GLint filter) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  for (GLenum name : {GLenum{GL_TEXTURE_MIN_FILTER}, GLenum{GL_TEXTURE_MAG_FILTER}})
    glTexParameteri(GL_TEXTURE_2D, name, filter);
  for (GLenum name : {GLenum{GL_TEXTURE_WRAP_S}, GLenum{GL_TEXTURE_WRAP_T}})
    glTexParameteri(GL_TEXTURE_2D, name, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  return texture;
}

void Attach(GLenum attachment, GLuint texture) {
  glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
}

void ResizeTexture(GLuint texture, const Picture& p) {
  BindTexture(kColorUnit, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, p.drawn_width_px, p.drawn_height_px, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
}

// A page's OpenGL refuses to look up the depth of what is drawn into: there it is copied first.
#ifdef __EMSCRIPTEN__
constexpr bool kCopiesDepth = true;
#else
constexpr bool kCopiesDepth = false;
#endif

void ResizeDepth(GLuint texture, const Picture& p) {
  BindTexture(kColorUnit, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, p.drawn_width_px, p.drawn_height_px, 0, GL_DEPTH_COMPONENT,
               GL_UNSIGNED_INT, nullptr);
}

void CopyDepth(const Picture& p) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, p.framebuffer);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, p.depth_copy_target);
  glBlitFramebuffer(0, 0, p.drawn_width_px, p.drawn_height_px, 0, 0, p.drawn_width_px, p.drawn_height_px,
                    GL_DEPTH_BUFFER_BIT, GL_NEAREST);
}

void ResizeDeferred(const Picture& p) {
  for (GLuint texture : {p.color, p.normals, p.lit_color}) ResizeTexture(texture, p);
  ResizeDepth(p.depth, p);
  if (kCopiesDepth) {
    ResizeDepth(p.depth_copy, p);
    glBindFramebuffer(GL_FRAMEBUFFER, p.depth_copy_target);
    Attach(GL_DEPTH_ATTACHMENT, p.depth_copy);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, p.framebuffer);
  Attach(GL_COLOR_ATTACHMENT0, p.color);
  Attach(GL_COLOR_ATTACHMENT1, p.normals);
  Attach(GL_DEPTH_ATTACHMENT, p.depth);
  const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glDrawBuffers(2, both);
  glBindFramebuffer(GL_FRAMEBUFFER, p.lit);
  Attach(GL_COLOR_ATTACHMENT0, p.lit_color);
  Attach(GL_DEPTH_ATTACHMENT, p.depth);
}

void ResizeForward(const Picture& p) {
  glBindFramebuffer(GL_FRAMEBUFFER, p.framebuffer);
  const GLsizei samples = p.samples > 1 ? p.samples : 0;
  if (samples > 0) {
    glBindRenderbuffer(GL_RENDERBUFFER, p.color);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, p.drawn_width_px, p.drawn_height_px);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, p.color);
  } else {
    ResizeTexture(p.color, p);
    Attach(GL_COLOR_ATTACHMENT0, p.color);
  }
  glBindRenderbuffer(GL_RENDERBUFFER, p.depth);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT24, p.drawn_width_px, p.drawn_height_px);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, p.depth);
}

bool IsCoarse(const Picture& p) { return p.drawn_width_px < p.width_px || p.drawn_height_px < p.height_px; }

void ResizeCoarse(Picture* p) {
  if (p->coarse == 0) glGenFramebuffers(1, &p->coarse);
  if (p->coarse_color == 0) p->coarse_color = NewTexture(GL_LINEAR);
  ResizeTexture(p->coarse_color, *p);
  glBindFramebuffer(GL_FRAMEBUFFER, p->coarse);
  Attach(GL_COLOR_ATTACHMENT0, p->coarse_color);
}

void DrawWhole(const Program& program, const Picture& p) {
  glUseProgram(program.id);
  CullBackFaces(false);
  glBindVertexArray(p.empty_array);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void BindFinished(const Picture& p) {
  glBindFramebuffer(GL_FRAMEBUFFER, p.finished);
  glViewport(0, 0, p.width_px, p.height_px);
}

// Into `framebuffer`, as large as it was drawn.
void Smooth(GLuint framebuffer, const Program& program, const Picture& p) {
  if (p.samples > 1) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, p.framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    glBlitFramebuffer(0, 0, p.drawn_width_px, p.drawn_height_px, 0, 0, p.drawn_width_px, p.drawn_height_px,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
    return;
  }
  if (framebuffer == p.finished) BindFinished(p);
  else glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  BindTexture(kColorUnit, p.deferred ? p.lit_color : p.color);
  DrawWhole(program, p);
}

void Enlarge(GLuint texture, const Picture& p) {
  BindFinished(p);
  BindTexture(kColorUnit, texture);
  DrawWhole(p.enlarge_program, p);
}

// The mean so far of this picture and those before it.
void Average(int average, const Picture& p) {
  glEnable(GL_BLEND);
  glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
  glBlendColor(0, 0, 0, 1 / static_cast<float>(average + 1));
  Enlarge(p.deferred ? p.lit_color : p.color, p);
  glDisable(GL_BLEND);
}

}  // namespace

Error CreatePicture(const PictureOptions& options, ShaderMode mode, Picture* p) {
  GLint most = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  p->samples = std::clamp(options.samples, 1, std::max<int>(most, 1));
  p->averages = options.averages;
  p->deferred = options.deferred;
  p->color = NewTexture(GL_LINEAR);
  if (p->samples > 1) glGenRenderbuffers(1, &p->color);
  glGenRenderbuffers(1, &p->depth);
  for (GLuint* framebuffer : {&p->framebuffer, &p->lit}) glGenFramebuffers(1, framebuffer);
  if (p->samples > 1 || p->averages > 1 || !options.onto_window) {
    glGenRenderbuffers(1, &p->finished_color);
    glGenFramebuffers(1, &p->finished);
  }
  glGenVertexArrays(1, &p->empty_array);
  if (p->deferred) {
    p->depth = NewTexture(GL_NEAREST);
    p->normals = NewTexture(GL_NEAREST);
    p->lit_color = NewTexture(GL_LINEAR);
    if (kCopiesDepth) {
      p->depth_copy = NewTexture(GL_NEAREST);
      glGenFramebuffers(1, &p->depth_copy_target);
    }
    p->coarse_color = p->color;  // which nobody needs once the light is done
    if (Error e = BuildProgram(ShaderProgram::kLight, mode, &p->light_program)) return e;
  }
  if (Error e = BuildProgram(ShaderProgram::kSmooth, mode, &p->smooth_program)) return e;
  if (Error e = BuildProgram(ShaderProgram::kSharpen, mode, &p->sharpen_program)) return e;
  return BuildProgram(ShaderProgram::kEnlarge, &p->enlarge_program);
}

void ResizePicture(int width_px, int height_px, float scale, Picture* p) {
  const auto drawn = [scale](int whole_px) {
    return std::clamp(static_cast<int>(std::lround(static_cast<float>(whole_px) * scale)), 1, whole_px);
  };
  const bool resized = p->width_px != width_px || p->height_px != height_px;
  const bool redrawn = p->drawn_width_px != drawn(width_px) || p->drawn_height_px != drawn(height_px);
  p->width_px = width_px;
  p->height_px = height_px;
  p->drawn_width_px = drawn(width_px);
  p->drawn_height_px = drawn(height_px);
  if (redrawn && p->deferred) ResizeDeferred(*p);
  else if (redrawn) ResizeForward(*p);
  if (redrawn && IsCoarse(*p)) ResizeCoarse(p);
  if (!resized || p->finished == 0) return;
  glBindRenderbuffer(GL_RENDERBUFFER, p->finished_color);
  glRenderbufferStorage(GL_RENDERBUFFER, p->averages > 1 ? GL_RGB10_A2 : GL_RGBA8, width_px, height_px);
  glBindFramebuffer(GL_FRAMEBUFFER, p->finished);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, p->finished_color);
}

void FinishBeside(bool beside, Picture* p) {
  if (beside && p->finished == 0) {
    glGenRenderbuffers(1, &p->finished_color);
    glGenFramebuffers(1, &p->finished);
    p->finishes_beside = true;
    p->width_px = 0;  // so that its size is set
  } else if (!beside && p->finishes_beside) {
    glDeleteRenderbuffers(1, &p->finished_color);
    glDeleteFramebuffers(1, &p->finished);
    p->finished = p->finished_color = 0;
    p->finishes_beside = false;
  }
}

void BeginPicture(const Picture& p) {
  glBindFramebuffer(GL_FRAMEBUFFER, p.framebuffer);
  glViewport(0, 0, p.drawn_width_px, p.drawn_height_px);
  glClear(GL_DEPTH_BUFFER_BIT | GL_COLOR_BUFFER_BIT);
}

void LightPicture(const Picture& p) {
  if (!p.deferred) return;
  if (kCopiesDepth) CopyDepth(p);
  glBindFramebuffer(GL_FRAMEBUFFER, p.lit);
  // Only where there is a surface. The depth is looked up and tested alike, and not written: software, which alone
  // defers light, does not mind.
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_GREATER);
  BindTexture(kColorUnit, p.color);
  BindTexture(kNormalsUnit, p.normals);
  BindTexture(kDepthUnit, kCopiesDepth ? p.depth_copy : p.depth);
  DrawWhole(p.light_program, p);
  BindTexture(kDepthUnit, 0);  // it is drawn into again
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LEQUAL);
}

void FinishPicture(int average, const Picture& p) {
  glDisable(GL_DEPTH_TEST);
  if (p.averages > 1) return Average(average, p);
  const bool coarse = IsCoarse(p);
  Smooth(coarse ? p.coarse : p.finished, coarse ? p.sharpen_program : p.smooth_program, p);
  if (coarse) Enlarge(p.coarse_color, p);
}

void PresentPicture(const Picture& p) {
  if (p.finished == 0) return;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, p.finished);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, p.window);
  glBlitFramebuffer(0, 0, p.width_px, p.height_px, p.left_px, p.bottom_px, p.left_px + p.width_px,
                    p.bottom_px + p.height_px, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace flaneur
