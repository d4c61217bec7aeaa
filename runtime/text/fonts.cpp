#include "runtime/text/fonts.h"

#include <hb-ot.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include "runtime/text/font.h"
#include "runtime/text/font_faces.h"

namespace flaneur {
namespace {

// False: not a font whose letters can be drawn at any size.
bool Open(std::span<const unsigned char> file, int index, FT_Library freetype, FontFace* face) {
  if (FT_New_Memory_Face(freetype, file.data(), static_cast<FT_Long>(file.size()), index, &face->drawn) != 0)
    return false;
  if (!FT_IS_SCALABLE(face->drawn) || face->drawn->units_per_EM == 0) {
    FT_Done_Face(face->drawn);
    return false;
  }
  face->units_per_em = static_cast<float>(face->drawn->units_per_EM);
  face->ascent_em = static_cast<float>(face->drawn->ascender) / face->units_per_em;
  face->descent_em = -static_cast<float>(face->drawn->descender) / face->units_per_em;
  hb_blob_t* blob = hb_blob_create(reinterpret_cast<const char*>(file.data()), static_cast<unsigned>(file.size()),
                                   HB_MEMORY_MODE_READONLY, nullptr, nullptr);
  hb_face_t* shaped = hb_face_create(blob, static_cast<unsigned>(index));
  face->shaped = hb_font_create(shaped);
  hb_ot_font_set_funcs(face->shaped);
  hb_face_destroy(shaped);
  hb_blob_destroy(blob);
  return true;
}

bool HasLetter(const FontFace& face, char32_t letter) { return FT_Get_Char_Index(face.drawn, letter) != 0; }

// Looked for on this machine; -1: there is none.
int Load(char32_t letter, const std::string& language, Fonts::Impl* f) {
  if (!f->find) return -1;
  std::optional<FontFile> file = f->find(letter, language);
  if (!file) return -1;
  FontFace face;
  face.name = file->name;
  face.language = language;
  face.bytes = std::move(file->bytes);
  if (!Open(face.bytes, file->face, f->freetype, &face)) return -1;
  f->faces.push_back(std::move(face));  // the bytes stay where they are
  return HasLetter(f->faces.back(), letter) ? static_cast<int>(f->faces.size()) - 1 : -1;
}

int Find(char32_t letter, const std::string& language, Fonts::Impl* f) {
  for (size_t k = 0; k < f->faces.size(); ++k) {
    // One script looks different in Chinese and in Japanese.
    if ((k == 0 || f->faces[k].language == language) && HasLetter(f->faces[k], letter)) return static_cast<int>(k);
  }
  return Load(letter, language, f);
}

}  // namespace

Fonts::Fonts(FindFont find) : impl_(std::make_unique<Impl>()) {
  impl_->find = std::move(find);
  FT_Init_FreeType(&impl_->freetype);
  FontFace face;
  face.name = "DejaVu Sans";
  Open(BuiltInFont(), 0, impl_->freetype, &face);
  impl_->faces.push_back(std::move(face));
}

Fonts::~Fonts() {
  for (const FontFace& face : impl_->faces) {
    hb_font_destroy(face.shaped);
    FT_Done_Face(face.drawn);
  }
  FT_Done_FreeType(impl_->freetype);
}

int Fonts::FontFor(char32_t letter, const std::string& language) {
  Impl& f = *impl_;
  const auto [entry, is_new] = f.found.try_emplace({letter, language}, -1);
  if (is_new) entry->second = Find(letter, language, &f);
  if (entry->second < 0 && f.missing_told.insert(letter).second) f.missing.push_back(letter);
  return entry->second;
}

bool Fonts::Has(int font, char32_t letter) const { return HasLetter(impl_->faces[static_cast<size_t>(font)], letter); }
const std::string& Fonts::NameOf(int font) const { return impl_->faces[static_cast<size_t>(font)].name; }
float Fonts::Ascent_em(int font) const { return impl_->faces[static_cast<size_t>(font)].ascent_em; }
float Fonts::Descent_em(int font) const { return impl_->faces[static_cast<size_t>(font)].descent_em; }

GlyphPicture Fonts::Draw(int font, uint32_t glyph, float em_px) const {
  GlyphPicture picture;
  const FT_Face face = impl_->faces[static_cast<size_t>(font)].drawn;
  constexpr float kParts = 64;
  constexpr FT_UInt kDotsPerInch = 72;  // then a point is a pixel
  if (FT_Set_Char_Size(face, 0, static_cast<FT_F26Dot6>(std::lround(em_px * kParts)), kDotsPerInch, kDotsPerInch) != 0)
    return picture;
  if (FT_Load_Glyph(face, glyph, FT_LOAD_TARGET_LIGHT | FT_LOAD_NO_BITMAP) != 0) return picture;
  if (FT_Render_Glyph(face->glyph, FT_RENDER_MODE_NORMAL) != 0) return picture;
  const FT_Bitmap& bitmap = face->glyph->bitmap;
  if (bitmap.pixel_mode != FT_PIXEL_MODE_GRAY) return picture;
  picture.left_px = face->glyph->bitmap_left;
  picture.top_px = -face->glyph->bitmap_top;
  picture.width_px = static_cast<int>(bitmap.width);
  picture.height_px = static_cast<int>(bitmap.rows);
  picture.cover.resize(size_t{bitmap.width} * bitmap.rows);
  for (size_t row = 0; row < bitmap.rows; ++row) {
    std::memcpy(&picture.cover[row * bitmap.width], bitmap.buffer + static_cast<std::ptrdiff_t>(row) * bitmap.pitch,
                bitmap.width);
  }
  return picture;
}

std::u32string Fonts::TakeMissing() { return std::exchange(impl_->missing, {}); }

}  // namespace flaneur
