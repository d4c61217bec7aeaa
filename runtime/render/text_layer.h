// Text of any language over the picture, shaped and in its own order, in Dear ImGui's draw lists: all that a visitor
// reads but captions. Between an Overlay's Begin and Draw.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "runtime/base/math.h"
#include "runtime/text/layout.h"

namespace flaneur {

struct GlyphAtlas;

// From the picture's upper left corner.
struct TextBox {
  float left_px = 0, top_px = 0, width_px = 0, height_px = 0;
};

enum class TextPlane { kWindow, kBehind, kFront };  // ImGui's current window, behind all windows, before them
enum class Upright { kTop, kMiddle };

struct TextLook : TextStyle {
  std::array<uint8_t, 4> color{247, 242, 230, 255};
  Upright upright = Upright::kMiddle;  // where in a box that is higher than the text
  TextPlane plane = TextPlane::kWindow;
};

// What has been written into the picture; for tests, that nothing is cut or leaves its box.
struct DrawnText {
  std::string text;
  TextBox box, covers;        // covers: where its lines are
  bool cut = false;           // not all of it is there
  bool broken_words = false;  // a word was wider than the box
};

class TextLayer {
 public:
  // fonts: outlives it; null for the built-in one.
  explicit TextLayer(Fonts* fonts = nullptr);
  ~TextLayer();
  void BeginPicture();                          // by Overlay::Begin
  const std::vector<DrawnText>& drawn() const;  // since then
  Fonts& fonts();
  GlyphAtlas& atlas();  // for the overlay's texture

  struct Impl;
  Impl& impl() { return *impl_; }  // internal to this layer

 private:
  std::unique_ptr<Impl> impl_;
};

struct TextRoom {
  float width_px = 0, height_px = 0;
  size_t lines = 1;
  bool broken_words = false;
};
// How much room the text takes, in lines at most so wide.
TextRoom RoomFor(const std::string& text, float width_px, const TextStyle& style, TextLayer* layer);

// In the box, in lines as wide as it. Text that is higher is cut to the lines that fit, with an ellipsis. False where
// it was cut.
bool DrawText(const std::string& text, const TextBox& box, const TextLook& look, TextLayer* layer);

}  // namespace flaneur
