// A picture over the whole window and a bar on it, with nothing but what OpenGL does without a shader: it is there at
// once.
#pragma once
#include "runtime/base/math.h"
#include "runtime/base/pixels.h"

namespace flaneur {

// In shares of the window's width and height, from its upper left corner.
struct BarOnTitle {
  float left = 0, right = 0, top = 0, bottom = 0;
  float share = 0;  // of it that is filled
  Vec3 color{0.89f, 0.64f, 0.29f}, ground{0.2f, 0.17f, 0.14f};
};

// Needs a current context for its whole life.
class TitleView {
 public:
  TitleView();
  ~TitleView();
  TitleView(const TitleView&) = delete;
  TitleView& operator=(const TitleView&) = delete;
  void SetPicture(const Pixels& picture);
  void Draw(const BarOnTitle& bar, int width_px, int height_px) const;

 private:
  unsigned texture_ = 0, framebuffer_ = 0;
  int width_px_ = 0, height_px_ = 0;
};

}  // namespace flaneur
