#include "runtime/render/caption.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/text/layout.h"

namespace flaneur {
namespace {

constexpr float kLetterShare = 1 / 20.0f, kLetterWidthShare = 1 / 24.0f;  // of the picture's height, but of its width
constexpr float kTextWidthShare = 0.84f, kMargin = 0.55f;                 // of the picture, in letters
constexpr float kMostShare = 0.5f;                                        // of the picture's height
constexpr float kSmaller = 0.94f, kLeastSize = 0.5f;
constexpr float kLeastInParts = 0.75f;   // of the wished size, letters are before a caption is shown in parts
constexpr float kLeastForWords = 0.75f;  // of the usual size, letters are before words are broken
constexpr float kMinLetter_px = 12;
constexpr int kMinPicture_px = 64;

using Color = std::array<uint8_t, 4>;
constexpr Color kStrip{18, 18, 18, 184}, kText{245, 245, 245, 255};
constexpr Color kStripHigh{0, 0, 0, 255}, kTextHigh{255, 238, 64, 255};

void PutGlyph(const GlyphPicture& glyph, Vec2 pen, const Color& strip, const Color& text, PackImage* image) {
  const int left = static_cast<int>(std::lround(pen.x)) + glyph.left_px;
  const int top = static_cast<int>(std::lround(pen.y)) + glyph.top_px;
  for (int j = 0; j < glyph.height_px; ++j) {
    for (int i = 0; i < glyph.width_px; ++i) {
      const int x = left + i, y = top + j;
      if (x < 0 || y < 0 || x >= image->width_px || y >= image->height_px) continue;
      const int cover = glyph.cover[static_cast<size_t>(j * glyph.width_px + i)];
      uint8_t* out = &image->rgba[static_cast<size_t>(y * image->width_px + x) * 4];
      for (size_t k = 0; k < 4; ++k)
        out[k] = static_cast<uint8_t>(std::max<int>(out[k], strip[k] + cover * (text[k] - strip[k]) / 255));
    }
  }
}

// Some of the lines, from the upper edge on.
TextLayout LinesOf(const TextLayout& whole, size_t first, size_t count) {
  TextLayout part = whole;
  const float line_px = whole.height_px / static_cast<float>(whole.lines.size());
  const TextLine &begin = whole.lines[first], &end = whole.lines[first + count - 1];
  const auto glyph = [&](size_t index) { return whole.glyphs.begin() + static_cast<std::ptrdiff_t>(index); };
  part.glyphs.assign(glyph(begin.first_glyph), glyph(end.first_glyph + end.glyphs));
  for (PlacedGlyph& g : part.glyphs) g.pen_px.y -= static_cast<float>(first) * line_px;
  part.height_px = static_cast<float>(count) * line_px;
  return part;
}

// Parts as even as can be.
TextLayout PartOf(const TextLayout& whole, float most_px, float passed, CaptionPart* part) {
  const size_t lines = whole.lines.size();
  const float line_px = whole.height_px / static_cast<float>(lines);
  const size_t most = std::max<size_t>(1, static_cast<size_t>(most_px / line_px));
  const size_t parts = (lines + most - 1) / most, each = (lines + parts - 1) / parts;
  *part = PartDue(passed, static_cast<int>((lines + each - 1) / each));
  const size_t first = static_cast<size_t>(part->index) * each;
  return LinesOf(whole, first, std::min(each, lines - first));
}

// As large as wished, or as the picture has room for.
TextLayout LayOut(const std::string& text, const CaptionStyle& style, float width_px, float height_px, Fonts* fonts,
                  float passed, CaptionPart* part) {
  const float usual_px = std::min(height_px * kLetterShare, width_px * kLetterWidthShare);
  TextStyle letters{.letter_px = std::max(kMinLetter_px, usual_px * style.size), .language = style.language};
  const auto room_px = [&] {
    return style.side == 0 ? width_px * kTextWidthShare : width_px * kCaptionPanel - 2 * kMargin * letters.letter_px;
  };
  const auto lay_out = [&] { return LayOutText(text, room_px(), letters, fonts); };
  const float least_px = std::max(kMinLetter_px, usual_px * kLeastSize);
  const float least_high_px = passed >= 0 ? std::max(least_px, usual_px * style.size * kLeastInParts) : least_px;
  const auto most_px = [&] { return height_px * kMostShare - 2 * kMargin * letters.letter_px; };
  TextLayout layout = lay_out();
  const auto shrink = [&](float to_px, const auto& while_it_helps) {
    while (letters.letter_px > to_px && while_it_helps()) {
      letters.letter_px = std::max(to_px, letters.letter_px * kSmaller);
      layout = lay_out();
    }
  };
  const float wished_px = letters.letter_px;
  shrink(std::max(kMinLetter_px, usual_px * kLeastForWords), [&] { return layout.broken_words; });
  if (layout.broken_words) {  // an address as long as two lines: nobody reads better for small letters
    letters.letter_px = wished_px;
    layout = lay_out();
  }
  shrink(least_high_px, [&] { return layout.height_px > most_px(); });
  if (layout.height_px <= height_px * kMostShare) return layout;
  if (passed >= 0) return PartOf(layout, most_px(), passed, part);
  const float line_px = layout.height_px / static_cast<float>(layout.lines.size());
  letters.most_lines = std::max(1, static_cast<int>(most_px() / line_px));
  return lay_out();
}

}  // namespace

CaptionPart PartDue(float passed, int count) {
  return {std::clamp(static_cast<int>(passed * static_cast<float>(count)), 0, count - 1), count};
}

PackImage LayOutCaption(const std::string& text, const CaptionStyle& style, int width_px, int height_px, Fonts* fonts,
                        float passed, CaptionPart* part) {
  PackImage image;
  CaptionPart due;
  if (text.find_first_not_of(' ') == std::string::npos || width_px < kMinPicture_px || height_px < kMinPicture_px)
    return image;
  const auto width = static_cast<float>(width_px), height = static_cast<float>(height_px);
  const TextLayout layout = LayOut(text, style, width, height, fonts, passed, &due);
  if (part != nullptr) *part = due;
  const float margin_px = kMargin * layout.em_px;
  const Color& strip = style.high_contrast ? kStripHigh : kStrip;
  const Color& letters = style.high_contrast ? kTextHigh : kText;
  image.width_px = width_px;
  image.height_px = std::min(height_px, static_cast<int>(std::ceil(layout.height_px + 2 * margin_px)));
  const float panel_px = style.side == 0 ? width : std::min(width, layout.width_px + 2 * margin_px);
  const float left_px = style.side > 0 ? width - panel_px : 0;
  const Color none{strip[0], strip[1], strip[2], 0};
  for (int i = 0; i < image.width_px * image.height_px; ++i) {
    const auto x = static_cast<float>(i % image.width_px);
    const Color& ground = x >= left_px && x < left_px + panel_px ? strip : none;
    image.rgba.insert(image.rgba.end(), ground.begin(), ground.end());
  }
  const Vec2 corner{left_px + (panel_px - layout.width_px) / 2 - layout.left_px, margin_px};
  for (const PlacedGlyph& g : layout.glyphs)
    PutGlyph(fonts->Draw(g.font, g.glyph, layout.em_px), corner + g.pen_px, strip, letters, &image);
  return image;
}

Error CreateCaptionView(Fonts* fonts, CaptionView* caption) {
  if (fonts == nullptr) caption->own_fonts = std::make_unique<Fonts>();
  caption->fonts = fonts == nullptr ? caption->own_fonts.get() : fonts;
  glGenVertexArrays(1, &caption->empty_array);
  glGenTextures(1, &caption->texture);
  return BuildProgram(ShaderProgram::kCaption, &caption->program);
}

void DrawCaption(const FrameInput& frame, int width_px, int height_px, CaptionView* c) {
  if (frame.caption != c->text || frame.caption_style != c->style || width_px != c->width_px ||
      height_px != c->height_px || PartDue(frame.caption_passed, c->part.count) != c->part) {
    c->part = {};
    const PackImage image = LayOutCaption(frame.caption, frame.caption_style, width_px, height_px, c->fonts,
                                          frame.caption_passed, &c->part);
    c->text = frame.caption, c->style = frame.caption_style;
    c->width_px = width_px, c->height_px = height_px, c->strip_px = image.height_px;
    if (c->strip_px == 0) return;
    BindTexture(kColorUnit, c->texture);
    for (GLenum filter : {GLenum{GL_TEXTURE_MIN_FILTER}, GLenum{GL_TEXTURE_MAG_FILTER}})
      glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image.width_px, image.height_px, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 image.rgba.data());
  }
  if (c->strip_px == 0 || frame.caption_share <= 0) return;
  glDisable(GL_DEPTH_TEST);
  CullBackFaces(false);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glUseProgram(c->program.id);
  SetUniform(c->program.share, frame.caption_share);
  BindTexture(kColorUnit, c->texture);
  glBindVertexArray(c->empty_array);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, width_px, c->strip_px);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
}

}  // namespace flaneur
