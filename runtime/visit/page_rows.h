// Rows of text and buttons on a page, in letters of any size: what does not fit side by side goes one below the other,
// and what does not fit on the page onto the next. Internal to runtime/visit; between an Overlay's Begin and Draw.
#pragma once
#include <string>
#include <vector>

#include "runtime/render/text_layer.h"
#include "runtime/visit/page_look.h"
#include "runtime/visit/rows.h"

namespace flaneur {

// A button of its own, at ImGui's place; pressed.
bool TextButton(const std::string& text, const std::string& id, float width_px, float height_px, Align align,
                const PageLook& look, TextLayer* layer);
// Likewise words, so wide; they take the height that they need.
void TextAt(const std::string& text, float width_px, Align align, const PageLook& look, TextLayer* layer);

// The row that keys choose. Whoever comes by keys or gamepad sees it at once; whoever comes by pointer or touch sees
// none until they press a key that goes from row to row, which shows the first one.
struct KeyMark {
  bool by_keys = true;  // what the hands did last
  bool is_shown = false, is_asked = false;
};
// After ImGui's Begin of the page, which takes the keys over when it appears. at_once: else no row is marked then.
void ShowKeyMark(KeyMark* mark, bool at_once = true);

// A page is gone through twice: first its rows only tell how high they are and none is pressed, then those that have
// room are there.
class PageRows : public Rows {
 public:
  PageRows(const PageLook& look, float width_px, TextLayer* text);

  bool Button(const std::string& text, const std::string& id) override;
  void Words(const std::string& text) override;
  int Amount(const std::string& text, const std::string& value) override;
  int Choice(const std::string& text, const std::vector<std::string>& buttons, const std::string& id) override;

  // From the first time to the second: rows from `first` on that fit into so many pixels, with a button for more where
  // not all do. False: there are no such rows.
  bool Fit(float height_px, size_t first, const std::string& more);
  bool more_pressed() const { return more_pressed_; }
  size_t end() const { return end_; }
  size_t count() const { return heights_px_.size(); }
  void ShowMore();                                                   // after the second time, where not all fit
  bool ButtonBelow(const std::string& text, const std::string& id);  // all rows, on every page; pressed
  float ButtonHeight_px(const std::string& text) const { return ButtonHeight_px(text, width_px_); }

 private:
  bool IsShown(float height_px);
  float ButtonHeight_px(const std::string& text, float width_px) const;
  bool ButtonAt(const std::string& text, const std::string& id, float width_px, float height_px, Align align) {
    return TextButton(text, id, width_px, height_px, align, look_, text_);
  }
  void WordsAt(const std::string& text, float width_px, float height_px);
  bool FitsBeside(const std::string& text, float width_px) const;

  PageLook look_;
  float width_px_;
  TextLayer* text_;
  std::vector<float> heights_px_;
  bool measures_ = true, more_pressed_ = false;
  size_t next_ = 0, first_ = 0, end_ = 0;
  std::string more_;
};

// The page's colours and spaces, as long as it lives.
struct PageStyle {
  explicit PageStyle(const PageLook& look, const KeyMark& mark = {.is_shown = true});
  ~PageStyle();
  PageStyle(const PageStyle&) = delete;
  PageStyle& operator=(const PageStyle&) = delete;
};

}  // namespace flaneur
