// Windows with text, buttons and graphs over the picture, by Dear ImGui: between Begin and Draw any source file may
// call it.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

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

// For ImDrawList::AddImage; null: none.
using OverlayPicture = void*;

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
  // RGBA, top row first; it stays until it is removed.
  OverlayPicture AddPicture(int width_px, int height_px, const std::vector<uint8_t>& rgba);
  void RemovePicture(OverlayPicture picture);  // not between Begin and Draw of a picture that shows it; null: nothing
  bool HasPointer() const;                     // it is over a window, or was pressed there; after Begin
  void Draw();  // over the picture that the renderer has just drawn, before it is read or presented

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flaneur
