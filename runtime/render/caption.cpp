#include "runtime/render/caption.h"

#include <algorithm>
#include <cmath>
#include <span>

#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wshadow"
#include <stb/stb_truetype.h>
#pragma GCC diagnostic pop

#include "runtime/render/font.h"

namespace flaneur {
namespace {

constexpr float kLetterShare = 1 / 20.0f, kTextWidthShare = 0.84f, kLineGap = 1.25f;
constexpr int kMinLetter_px = 12, kMinPicture_px = 64;
constexpr float kStripShare = 0.72f;  // how much of the picture the empty strip hides
constexpr uint8_t kStripColor = 18;

const stbtt_fontinfo& Font() {
  static const stbtt_fontinfo font = [] {
    stbtt_fontinfo f;
    stbtt_InitFont(&f, FontFile().data(), 0);
    return f;
  }();
  return font;
}

// Broken bytes become question marks.
std::vector<int> CodePoints(const std::string& text) {
  std::vector<int> out;
  for (size_t i = 0; i < text.size();) {
    const auto lead = static_cast<uint8_t>(text[i++]);
    const int more = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : 0;
    int code = more == 0 ? lead : lead & (0x3F >> more);
    bool good = lead < 0x80 || lead >= 0xC0;
    for (int k = 0; k < more && good; ++k) {
      good = i < text.size() && (static_cast<uint8_t>(text[i]) & 0xC0) == 0x80;
      if (good) code = code << 6 | (static_cast<uint8_t>(text[i++]) & 0x3F);
    }
    out.push_back(good ? (code < ' ' ? ' ' : code) : '?');
  }
  return out;
}

float Width(std::span<const int> letters, float scale) {
  float width = 0;
  for (size_t i = 0; i < letters.size(); ++i) {
    int advance = 0, bearing = 0;
    stbtt_GetCodepointHMetrics(&Font(), letters[i], &advance, &bearing);
    width += static_cast<float>(advance) * scale;
    if (i + 1 < letters.size())
      width += static_cast<float>(stbtt_GetCodepointKernAdvance(&Font(), letters[i], letters[i + 1])) * scale;
  }
  return width;
}

// Lines of whole words; a word wider than the line stands alone and is cut at the picture's edge.
std::vector<std::vector<int>> Wrap(const std::vector<int>& letters, float scale, float width_px) {
  std::vector<std::vector<int>> lines(1);
  std::vector<int> word;
  const auto end_word = [&] {
    if (word.empty()) return;
    std::vector<int> longer = lines.back();
    if (!longer.empty()) longer.push_back(' ');
    longer.insert(longer.end(), word.begin(), word.end());
    if (lines.back().empty() || Width(longer, scale) <= width_px) lines.back() = std::move(longer);
    else lines.push_back(word);
    word.clear();
  };
  for (int letter : letters) {
    if (letter == ' ') end_word();
    else word.push_back(letter);
  }
  end_word();
  return lines;
}

void PutLetter(int letter, float x, float baseline, float scale, PackImage* image) {
  const float whole = std::floor(x);
  int left = 0, top = 0, right = 0, bottom = 0;
  stbtt_GetCodepointBitmapBoxSubpixel(&Font(), letter, scale, scale, x - whole, 0, &left, &top, &right, &bottom);
  const int width = right - left, height = bottom - top;
  if (width <= 0 || height <= 0) return;
  std::vector<uint8_t> cover(static_cast<size_t>(width) * static_cast<size_t>(height));
  stbtt_MakeCodepointBitmapSubpixel(&Font(), cover.data(), width, height, width, scale, scale, x - whole, 0, letter);
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const int px = static_cast<int>(whole) + left + i, py = static_cast<int>(baseline) + top + j;
      if (px < 0 || py < 0 || px >= image->width_px || py >= image->height_px) continue;
      const int c = cover[static_cast<size_t>(j * width + i)];
      uint8_t* out = &image->rgba[static_cast<size_t>(py * image->width_px + px) * 4];
      for (int k = 0; k < 3; ++k)
        out[k] = static_cast<uint8_t>(std::max<int>(out[k], kStripColor + c * (245 - kStripColor) / 255));
      out[3] = static_cast<uint8_t>(std::max<int>(out[3], c));
    }
  }
}

void PutLine(std::span<const int> letters, float baseline, float scale, PackImage* image) {
  float x = (static_cast<float>(image->width_px) - Width(letters, scale)) / 2;
  for (size_t i = 0; i < letters.size(); ++i) {
    PutLetter(letters[i], x, baseline, scale, image);
    x += Width(letters.subspan(i, 1), scale);
    if (i + 1 < letters.size())
      x += static_cast<float>(stbtt_GetCodepointKernAdvance(&Font(), letters[i], letters[i + 1])) * scale;
  }
}

}  // namespace

PackImage LayOutCaption(const std::string& text, int width_px, int height_px) {
  PackImage image;
  if (text.find_first_not_of(' ') == std::string::npos || width_px < kMinPicture_px || height_px < kMinPicture_px)
    return image;
  const float letter_px = std::max<float>(kMinLetter_px, static_cast<float>(height_px) * kLetterShare);
  const float scale = stbtt_ScaleForPixelHeight(&Font(), letter_px);
  const auto lines = Wrap(CodePoints(text), scale, static_cast<float>(width_px) * kTextWidthShare);
  int ascent = 0, descent = 0, gap = 0;
  stbtt_GetFontVMetrics(&Font(), &ascent, &descent, &gap);
  const float line_px = letter_px * kLineGap, margin_px = letter_px * 0.55f;
  image.width_px = width_px;
  image.height_px = std::min(height_px, static_cast<int>(static_cast<float>(lines.size()) * line_px + 2 * margin_px));
  const std::array<uint8_t, 4> strip{kStripColor, kStripColor, kStripColor, static_cast<uint8_t>(kStripShare * 255)};
  for (int i = 0; i < image.width_px * image.height_px; ++i)
    image.rgba.insert(image.rgba.end(), strip.begin(), strip.end());
  float baseline = margin_px + (line_px - letter_px) / 2 + static_cast<float>(ascent) * scale;
  for (const std::vector<int>& line : lines) {
    PutLine(line, std::round(baseline), scale, &image);
    baseline += line_px;
  }
  return image;
}

Error CreateCaptionView(CaptionView* caption) {
  glGenVertexArrays(1, &caption->empty_array);
  glGenTextures(1, &caption->texture);
  return BuildProgram(ShaderProgram::kCaption, &caption->program);
}

void DrawCaption(const std::string& text, float share, int width_px, int height_px, CaptionView* c) {
  if (text != c->text || width_px != c->width_px || height_px != c->height_px) {
    const PackImage image = LayOutCaption(text, width_px, height_px);
    c->text = text, c->width_px = width_px, c->height_px = height_px, c->strip_px = image.height_px;
    if (c->strip_px == 0) return;
    BindTexture(kColorUnit, c->texture);
    for (GLenum filter : {GLenum{GL_TEXTURE_MIN_FILTER}, GLenum{GL_TEXTURE_MAG_FILTER}})
      glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image.width_px, image.height_px, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 image.rgba.data());
  }
  if (c->strip_px == 0 || share <= 0) return;
  glDisable(GL_DEPTH_TEST);
  CullBackFaces(false);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glUseProgram(c->program.id);
  SetUniform(c->program.share, share);
  BindTexture(kColorUnit, c->texture);
  glBindVertexArray(c->empty_array);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, width_px, c->strip_px);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
}

}  // namespace flaneur
