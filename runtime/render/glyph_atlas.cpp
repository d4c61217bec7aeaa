#include "runtime/render/glyph_atlas.h"

#include <algorithm>
#include <cstring>

namespace flaneur {
namespace {

constexpr int kGap_px = 1;  // so that neighbours do not shine through

}  // namespace

std::optional<AtlasGlyph> PlaceGlyph(const Fonts& fonts, int font, uint32_t glyph, float em_px, GlyphAtlas* a) {
  const auto found = a->glyphs.find({font, glyph, em_px});
  if (found != a->glyphs.end()) return found->second;
  if (a->full) return std::nullopt;
  const GlyphPicture picture = fonts.Draw(font, glyph, em_px);
  if (a->x_px + picture.width_px + kGap_px > kGlyphAtlas_px) {
    a->y_px += a->row_px;
    a->x_px = a->row_px = 0;
  }
  if (picture.width_px + kGap_px > kGlyphAtlas_px || a->y_px + picture.height_px + kGap_px > kGlyphAtlas_px) {
    a->full = true;
    return std::nullopt;
  }
  if (a->cover.empty()) a->cover.resize(size_t{kGlyphAtlas_px} * kGlyphAtlas_px);
  const AtlasGlyph placed{a->x_px, a->y_px, picture.width_px, picture.height_px, picture.left_px, picture.top_px};
  for (int row = 0; row < picture.height_px; ++row) {
    std::memcpy(&a->cover[static_cast<size_t>((a->y_px + row) * kGlyphAtlas_px + a->x_px)],
                &picture.cover[static_cast<size_t>(row * picture.width_px)], static_cast<size_t>(picture.width_px));
  }
  const bool changed = a->changed_to > a->changed_from;
  a->changed_from = changed ? std::min(a->changed_from, a->y_px) : a->y_px;
  a->changed_to = std::max(changed ? a->changed_to : 0, a->y_px + picture.height_px);
  a->x_px += picture.width_px + kGap_px;
  a->row_px = std::max(a->row_px, picture.height_px + kGap_px);
  a->glyphs[{font, glyph, em_px}] = placed;
  return placed;
}

void MakeRoom(GlyphAtlas* a) {
  if (!a->full) return;
  std::fill(a->cover.begin(), a->cover.end(), uint8_t{0});
  a->glyphs.clear();
  a->x_px = a->y_px = a->row_px = 0;
  a->changed_from = 0;
  a->changed_to = kGlyphAtlas_px;
  a->full = false;
}

}  // namespace flaneur
