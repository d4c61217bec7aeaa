// The tour's title page in a window, from the moment that there is one until the tour can be walked through. Internal
// to runtime/desktop.
#pragma once
#include "runtime/desktop/context.h"
#include "runtime/pack/title_page.h"
#include "runtime/render/title_view.h"
#include "runtime/visit/title_layout.h"

namespace flaneur {

class TitleScreen {
 public:
  // The window's context is current for its whole life.
  TitleScreen(const PackTitle& title, Window* window);
  // share: of the loading that is done. The bar goes there smoothly, and a little further while nothing is heard.
  void Show(float share);

 private:
  Window* window_;
  TitlePictures pictures_;
  TitleView view_;
  int width_px_ = 0, height_px_ = 0;
  float shown_share_ = 0;
  double shown_s_ = 0;
};

}  // namespace flaneur
