// Words at the foot of the picture. Internal to runtime/render.
#pragma once
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/pack/tour_pack.h"
#include "runtime/render/gl_objects.h"

namespace flaneur {

// A dark translucent strip as wide as the picture, with the text (UTF-8) wrapped and centred on it. Letters are about a
// twentieth of the picture's height. No text, or a picture under 64 pixels: an empty image.
PackImage LayOutCaption(const std::string& text, int width_px, int height_px);

struct CaptionView {
  Program program;
  GLuint texture = 0, empty_array = 0;
  std::string text;                 // that the texture shows
  int width_px = 0, height_px = 0;  // of the picture that it was laid out for
  int strip_px = 0;                 // its own height
};

Error CreateCaptionView(CaptionView* caption);
// Over the bound picture; share: how much of it is seen.
void DrawCaption(const std::string& text, float share, int width_px, int height_px, CaptionView* caption);

}  // namespace flaneur
