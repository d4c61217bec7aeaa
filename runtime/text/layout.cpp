#include "runtime/text/layout.h"

#include <algorithm>
#include <cmath>

#include "runtime/text/paragraph.h"
#include "runtime/text/unicode.h"

namespace flaneur {
namespace {

constexpr char32_t kEllipsis = U'…';

std::vector<std::u32string> ParagraphsOf(const std::u32string& text) {
  std::vector<std::u32string> paragraphs(1);
  for (const char32_t c : text) {
    if (c == U'\n' || c == 0x2028 || c == 0x2029) paragraphs.emplace_back();
    else if (c != U'\r') paragraphs.back().push_back(c < U' ' ? U' ' : c);
  }
  return paragraphs;
}

void PlaceLine(const Paragraph& p, const LineRange& range, size_t first_letter, float width_px, const TextStyle& style,
               float* top_px, TextLayout* layout) {
  const ShapedLine shaped = ShapeLine(p, range);
  const float em_px = layout->em_px;
  float ascent_px = 0, descent_px = 0;
  for (const ShapedGlyph& g : shaped.glyphs) {
    ascent_px = std::max(ascent_px, p.fonts->Ascent_em(g.font) * em_px);
    descent_px = std::max(descent_px, p.fonts->Descent_em(g.font) * em_px);
  }
  ascent_px = std::max(ascent_px, p.fonts->Ascent_em(0) * em_px);
  descent_px = std::max(descent_px, p.fonts->Descent_em(0) * em_px);
  const float high_px = std::max(ascent_px + descent_px, style.letter_px * style.line_gap);
  const float room_px = width_px - shaped.width_em * em_px;
  const bool at_right = (style.align == Align::kEnd) != p.right_to_left;
  TextLine line{layout->glyphs.size(), shaped.glyphs.size(), 0, shaped.width_em * em_px, 0};
  line.left_px = style.align == Align::kCenter ? room_px / 2 : at_right ? room_px : 0;
  line.baseline_px = std::round(*top_px + (high_px - ascent_px - descent_px) / 2 + ascent_px);
  *top_px += high_px;
  for (const ShapedGlyph& g : shaped.glyphs) {
    const Vec2 pen{line.left_px + g.pen_em.x * em_px, line.baseline_px - g.pen_em.y * em_px};
    layout->glyphs.push_back({g.font, g.glyph, pen, first_letter + g.letter});
  }
  layout->lines.push_back(line);
}

TextLayout LayOut(const std::u32string& text, float width_px, const TextStyle& style, Fonts* fonts) {
  TextLayout layout;
  layout.em_px = style.letter_px / (fonts->Ascent_em(0) + fonts->Descent_em(0));
  float top_px = 0;
  size_t first_letter = 0;
  for (const std::u32string& part : ParagraphsOf(text)) {
    const Paragraph p = MakeParagraph(part, style.language, fonts);
    if (first_letter == 0) layout.right_to_left = p.right_to_left;
    for (const LineRange& range : BreakLines(p, width_px / layout.em_px)) {
      layout.broken_words = layout.broken_words || range.breaks_word;
      PlaceLine(p, range, first_letter, width_px, style, &top_px, &layout);
    }
    first_letter += part.size() + 1;
  }
  float left_px = width_px, right_px = 0;
  for (const TextLine& line : layout.lines) {
    left_px = std::min(left_px, line.left_px);
    right_px = std::max(right_px, line.left_px + line.width_px);
  }
  layout.left_px = left_px;
  layout.width_px = std::max(0.0f, right_px - left_px);
  layout.height_px = top_px;
  return layout;
}

}  // namespace

TextLayout LayOutText(const std::string& text, float width_px, const TextStyle& style, Fonts* fonts) {
  const std::u32string letters = CodePoints(text);
  TextLayout layout = LayOut(letters, width_px, style, fonts);
  const auto most = static_cast<size_t>(style.most_lines);
  if (most == 0 || layout.lines.size() <= most) return layout;
  size_t fits = 0, too_long = letters.size();
  while (fits + 1 < too_long) {
    const size_t half = (fits + too_long) / 2;
    const auto tried = LayOut(letters.substr(0, half) + kEllipsis, width_px, style, fonts);
    (tried.lines.size() <= most ? fits : too_long) = half;
  }
  std::u32string kept = letters.substr(0, fits);
  while (!kept.empty() && kept.back() == U' ') kept.pop_back();
  layout = LayOut(kept + kEllipsis, width_px, style, fonts);
  layout.cut = true;
  return layout;
}

}  // namespace flaneur
