// What stands behind Fonts. Internal to runtime/text.
#pragma once
#include <ft2build.h>
#include FT_FREETYPE_H
#include <hb.h>

#include <map>
#include <set>
#include <utility>

#include "runtime/text/fonts.h"

namespace flaneur {

struct FontFace {
  std::string name, language;   // language: in which it was looked for
  std::vector<uint8_t> bytes;   // of the file; empty: the built-in one
  FT_Face drawn = nullptr;      // by FreeType
  hb_font_t* shaped = nullptr;  // by HarfBuzz, in units of the font
  float units_per_em = 1, ascent_em = 1, descent_em = 0.2f;
};

struct Fonts::Impl {
  FindFont find;
  FT_Library freetype = nullptr;
  std::vector<FontFace> faces;
  std::map<std::pair<char32_t, std::string>, int> found;  // by letter and language
  std::set<char32_t> missing_told;
  std::u32string missing;
};

}  // namespace flaneur
