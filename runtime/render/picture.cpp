#include "runtime/render/picture.h"

#include <algorithm>

#include "runtime/render/shaders.h"

namespace flaneur {

Error CreatePicture(int samples, Picture* p) {
  GLint most = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  p->samples = std::clamp(samples, 1, std::max<int>(most, 1));
  glGenTextures(1, &p->color);
  glBindTexture(GL_TEXTURE_2D, p->color);
  for (GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
  for (GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  if (p->samples > 1) glGenRenderbuffers(1, &p->color);
  glGenRenderbuffers(1, &p->depth);
  glGenRenderbuffers(1, &p->finished_color);
  glGenFramebuffers(1, &p->framebuffer);
  glGenFramebuffers(1, &p->finished);
  glGenVertexArrays(1, &p->empty_array);
  return BuildProgram(kWholeVertex, kSmoothFragment, &p->smooth_program);
}

void ResizePicture(int width_px, int height_px, Picture* p) {
  if (p->width_px == width_px && p->height_px == height_px) return;
  p->width_px = width_px;
  p->height_px = height_px;
  glBindFramebuffer(GL_FRAMEBUFFER, p->framebuffer);
  const GLsizei samples = p->samples > 1 ? p->samples : 0;
  if (samples > 0) {
    glBindRenderbuffer(GL_RENDERBUFFER, p->color);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, width_px, height_px);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, p->color);
  } else {
    BindTexture(kColorUnit, p->color);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_px, height_px, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, p->color, 0);
  }
  glBindRenderbuffer(GL_RENDERBUFFER, p->depth);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT24, width_px, height_px);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, p->depth);
  glBindRenderbuffer(GL_RENDERBUFFER, p->finished_color);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width_px, height_px);
  glBindFramebuffer(GL_FRAMEBUFFER, p->finished);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, p->finished_color);
}

void FinishPicture(const Picture& p) {
  if (p.samples > 1) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, p.framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, p.finished);
    glBlitFramebuffer(0, 0, p.width_px, p.height_px, 0, 0, p.width_px, p.height_px, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    return;
  }
  glBindFramebuffer(GL_FRAMEBUFFER, p.finished);
  glDisable(GL_DEPTH_TEST);
  CullBackFaces(false);
  glUseProgram(p.smooth_program);
  BindTexture(kColorUnit, p.color);
  glBindVertexArray(p.empty_array);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace flaneur
