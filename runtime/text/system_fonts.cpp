#include "runtime/text/system_fonts.h"

#include <fontconfig/fontconfig.h>

#include <memory>

#include "runtime/base/file.h"

namespace flaneur {
namespace {

using Pattern = std::unique_ptr<FcPattern, decltype(&FcPatternDestroy)>;
using Letters = std::unique_ptr<FcCharSet, decltype(&FcCharSetDestroy)>;

Pattern Wish(char32_t letter, const std::string& language) {
  Pattern wish(FcPatternCreate(), FcPatternDestroy);
  const Letters letters(FcCharSetCreate(), FcCharSetDestroy);
  FcCharSetAddChar(letters.get(), letter);
  FcPatternAddCharSet(wish.get(), FC_CHARSET, letters.get());
  FcPatternAddBool(wish.get(), FC_SCALABLE, FcTrue);
  FcPatternAddString(wish.get(), FC_FAMILY, reinterpret_cast<const FcChar8*>("sans-serif"));
  if (!language.empty()) FcPatternAddString(wish.get(), FC_LANG, reinterpret_cast<const FcChar8*>(language.c_str()));
  FcConfigSubstitute(nullptr, wish.get(), FcMatchPattern);
  FcDefaultSubstitute(wish.get());
  return wish;
}

bool Shows(const FcPattern* font, char32_t letter) {
  FcCharSet* letters = nullptr;
  return FcPatternGetCharSet(font, FC_CHARSET, 0, &letters) == FcResultMatch && FcCharSetHasChar(letters, letter);
}

std::optional<FontFile> Read(const FcPattern* font) {
  FcChar8 *path = nullptr, *name = nullptr;
  FontFile file;
  if (FcPatternGetString(font, FC_FILE, 0, &path) != FcResultMatch) return std::nullopt;
  FcPatternGetInteger(font, FC_INDEX, 0, &file.face);
  if (FcPatternGetString(font, FC_FAMILY, 0, &name) == FcResultMatch) file.name = reinterpret_cast<const char*>(name);
  if (ReadFile(reinterpret_cast<const char*>(path), &file.bytes)) return std::nullopt;
  return file;
}

}  // namespace

FindFont SystemFonts() {
  return [](char32_t letter, const std::string& language) -> std::optional<FontFile> {
    const Pattern wish = Wish(letter, language);
    FcResult result = FcResultNoMatch;
    const Pattern best(FcFontMatch(nullptr, wish.get(), &result), FcPatternDestroy);
    // The best match need not have the letter.
    if (!best || !Shows(best.get(), letter)) return std::nullopt;
    return Read(best.get());
  };
}

}  // namespace flaneur
