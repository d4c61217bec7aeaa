// Windows with text, buttons and graphs over the picture, by Dear ImGui: between Begin and Draw any source file may
// call it.
#pragma once
#include <memory>
#include <string>

#include "runtime/base/error.h"
#include "runtime/base/math.h"
#include "runtime/render/text_layer.h"

namespace flaneur {

struct OverlayInput {
  Vec2 pointer_px{-1, -1};  // from the upper left corner; negative: none
  bool pressed = false;     // its main button
  bool up = false, down = false, left = false, right = false,
       activate = false;  // held: from one button to the next without a pointer
  float passed_s = 1.0f / 60;
};

// Needs a current context for its whole life. One at a time.
class Overlay {
 public:
  // fonts: of its text, outliving it; null for the built-in one.
  explicit Overlay(Fonts* fonts = nullptr);
  ~Overlay();
  // Errors: a shader that the driver refuses.
  Error Create();
  TextLayer& text();  // for all that visitors read; developers have ImGui's own letters
  void Begin(int width_px, int height_px, const OverlayInput& input);
  bool HasPointer() const;  // it is over a window, or was pressed there; after Begin
  void Draw();              // over the picture that the renderer has just drawn, before it is read or presented

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flaneur
