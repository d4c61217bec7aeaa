// Words at the foot of the picture. But for LayOutCaption internal to runtime/render.
#pragma once
#include <memory>
#include <string>

#include "runtime/base/error.h"
#include "runtime/pack/tour_pack.h"
#include "runtime/render/frame.h"
#include "runtime/render/gl_objects.h"
#include "runtime/text/fonts.h"

namespace flaneur {

// Of a caption that is too long for the picture, shown part by part.
struct CaptionPart {
  int index = 0, count = 1;
  friend bool operator==(const CaptionPart&, const CaptionPart&) = default;
};
// passed: of the time in which all of it is read; below 0: not known, and the first is due.
CaptionPart PartDue(float passed, int count);

// A dark strip as wide as the picture, with the text (UTF-8) wrapped on it: one line in the middle, several beginning
// at one edge. Letters are about a twentieth of the picture's height, smaller where the strip would cover more than
// half of the picture. Of what does not fit even so the part that is due is there or, where `passed` is not known, what
// fits. On one side it is a panel of at most kCaptionPanel of the picture's width. No text, or a picture under 64
// pixels: an empty image.
PackImage LayOutCaption(const std::string& text, const CaptionStyle& style, int width_px, int height_px, Fonts* fonts,
                        float passed = -1, CaptionPart* part = nullptr);

inline constexpr float kCaptionPanel = 0.62f;

struct CaptionView {
  Program program;
  Fonts* fonts = nullptr;
  std::unique_ptr<Fonts> own_fonts;  // where none are given
  GLuint texture = 0, empty_array = 0;
  std::string text;  // that the texture shows
  CaptionStyle style;
  int width_px = 0, height_px = 0;  // of the picture that it was laid out for
  int strip_px = 0;                 // its own height
  CaptionPart part;
};

// fonts: null for the built-in one.
Error CreateCaptionView(Fonts* fonts, CaptionView* caption);
// Over the bound picture; share: how much of it is seen.
void DrawCaption(const FrameInput& frame, int width_px, int height_px, CaptionView* caption);

}  // namespace flaneur
