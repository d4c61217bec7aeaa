// One paragraph: its order, its scripts and fonts, its lines. Internal to runtime/text.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/base/math.h"
#include "runtime/text/fonts.h"

namespace flaneur {

// Letters beside each other that are shaped together.
struct TextRun {
  size_t first = 0, end = 0;
  uint8_t level = 0;    // of the bidirectional algorithm; odd: from right to left
  uint32_t script = 0;  // as HarfBuzz numbers it
  int font = 0;
};

struct Paragraph {
  std::u32string text;
  std::string language;
  bool right_to_left = false;
  std::vector<TextRun> runs;      // in the order in which one reads
  std::vector<char> break_after;  // by letter: a line may end there
  std::vector<float> width_em;    // by letter: of the cluster that begins there
  std::vector<char> begins;       // by letter: a cluster does
  Fonts* fonts = nullptr;
};

Paragraph MakeParagraph(const std::u32string& text, const std::string& language, Fonts* fonts);

struct LineRange {
  size_t first = 0, end = 0;  // without spaces at the end
  bool breaks_word = false;
};

// At least one, which may be empty.
std::vector<LineRange> BreakLines(const Paragraph& paragraph, float width_em);

struct ShapedGlyph {
  int font = 0;
  uint32_t glyph = 0;
  Vec2 pen_em;  // y up
  size_t letter = 0;
};

// From left to right.
struct ShapedLine {
  std::vector<ShapedGlyph> glyphs;
  float width_em = 0;
};

ShapedLine ShapeLine(const Paragraph& paragraph, const LineRange& range);

}  // namespace flaneur
