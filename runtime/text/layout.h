// Text of any language in lines: shaped by HarfBuzz, in the order of Unicode's bidirectional algorithm (FriBidi),
// broken by its line breaking algorithm (libunibreak).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/base/math.h"
#include "runtime/text/fonts.h"

namespace flaneur {

enum class Align { kStart, kCenter, kEnd };  // start: left, or right in text that runs from right to left

struct TextStyle {
  float letter_px = 20;  // from the top of the tallest letter to the bottom of the lowest
  std::string language;  // such as "de"; empty: not known
  Align align = Align::kStart;
  int most_lines = 0;      // what is beyond is cut off, with an ellipsis; 0: as many lines as it takes
  float line_gap = 1.25f;  // from line to line, in letters
};

struct PlacedGlyph {
  int font = 0;
  uint32_t glyph = 0;
  Vec2 pen_px;        // on the baseline, from the text's upper left corner, y down
  size_t letter = 0;  // the first code point that it shows
};

struct TextLine {
  size_t first_glyph = 0, glyphs = 0;
  float left_px = 0, width_px = 0, baseline_px = 0;
};

struct TextLayout {
  std::vector<PlacedGlyph> glyphs;
  std::vector<TextLine> lines;
  float em_px = 0;                                 // of all glyphs, for Fonts::Draw
  float left_px = 0, width_px = 0, height_px = 0;  // of what is written
  bool right_to_left = false;                      // its first paragraph
  bool cut = false;                                // not all of it is there
  bool broken_words = false;                       // a word was wider than the line
};

// UTF-8 in lines at most so wide. A line break of the text begins a paragraph of its own.
TextLayout LayOutText(const std::string& text, float width_px, const TextStyle& style, Fonts* fonts);

}  // namespace flaneur
