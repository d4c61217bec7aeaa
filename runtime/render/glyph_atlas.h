// Glyphs side by side in one picture, for a texture. Internal to runtime/render.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "runtime/text/fonts.h"

namespace flaneur {

inline constexpr int kGlyphAtlas_px = 2048;  // wide and high

struct AtlasGlyph {
  int x_px = 0, y_px = 0, width_px = 0, height_px = 0;  // in the atlas
  int left_px = 0, top_px = 0;                          // GlyphPicture's
};

struct GlyphAtlas {
  std::vector<uint8_t> cover;                                     // kGlyphAtlas_px squared; empty until the first glyph
  std::map<std::tuple<int, uint32_t, float>, AtlasGlyph> glyphs;  // by font, glyph and em in pixels
  int x_px = 0, y_px = 0, row_px = 0;    // where the next one goes, and how high its row is so far
  int changed_from = 0, changed_to = 0;  // rows that a texture does not have yet
  bool full = false;
};

// Nothing: there is no room left.
std::optional<AtlasGlyph> PlaceGlyph(const Fonts& fonts, int font, uint32_t glyph, float em_px, GlyphAtlas* atlas);
// Forgets all, where it was full.
void MakeRoom(GlyphAtlas* atlas);

}  // namespace flaneur
