#include "runtime/render/title_view.h"

#include <GLES3/gl3.h>

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

// From the upper left corner; fills with the colour.
void Fill(const BarOnTitle& bar, float right, Vec3 color, int width_px, int height_px) {
  const auto at = [](float share, int length) {
    return static_cast<GLint>(std::lround(share * static_cast<float>(length)));
  };
  const GLint left_px = at(bar.left, width_px), top_px = at(bar.top, height_px);
  const GLsizei wide_px = std::max(0, at(right, width_px) - left_px);
  const GLsizei high_px = std::max(2, at(bar.bottom, height_px) - top_px);
  if (wide_px == 0) return;
  glScissor(left_px, height_px - top_px - high_px, wide_px, high_px);
  glClearColor(color.x, color.y, color.z, 1);
  glClear(GL_COLOR_BUFFER_BIT);
}

}  // namespace

TitleView::TitleView() {
  glGenTextures(1, &texture_);
  glGenFramebuffers(1, &framebuffer_);
}

TitleView::~TitleView() {
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteTextures(1, &texture_);
}

void TitleView::SetPicture(const Pixels& picture) {
  width_px_ = picture.width;
  height_px_ = picture.height;
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_px_, height_px_, 0, GL_RGBA, GL_UNSIGNED_BYTE, picture.rgba.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glBindTexture(GL_TEXTURE_2D, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void TitleView::Draw(const BarOnTitle& bar, int width_px, int height_px) const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, width_px, height_px);
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  // The picture's first row is the upper one.
  glBlitFramebuffer(0, 0, width_px_, height_px_, 0, height_px, width_px, 0, GL_COLOR_BUFFER_BIT, GL_LINEAR);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glEnable(GL_SCISSOR_TEST);
  Fill(bar, bar.right, bar.ground, width_px, height_px);
  Fill(bar, bar.left + std::clamp(bar.share, 0.0f, 1.0f) * (bar.right - bar.left), bar.color, width_px, height_px);
  glDisable(GL_SCISSOR_TEST);
}

}  // namespace flaneur
