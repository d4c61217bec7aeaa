// Windows with text, buttons and graphs over the picture, by Dear ImGui: between Begin and Draw any source file may call it.
#pragma once
#include <memory>

#include "runtime/base/error.h"
#include "runtime/base/math.h"

namespace flaneur {

struct OverlayInput {
  Vec2 pointer_px{-1, -1};  // from the upper left corner; negative: none
  bool pressed = false;     // its main button
  float passed_s = 1.0f / 60;
};

// Needs a current context for its whole life. One at a time.
class Overlay {
 public:
  Overlay();
  ~Overlay();
  // Errors: a shader that the driver refuses.
  Error Create();
  void Begin(int width_px, int height_px, const OverlayInput& input);
  void Draw();  // over the picture that the renderer has just drawn, before it is read or presented

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flaneur
