#include "pipeline/cli/check_words.h"

#include <set>

#include "runtime/base/text.h"
#include "runtime/text/unicode.h"

namespace flaneur {
namespace {

constexpr size_t kMostNamed = 8;  // letters, in one line

std::string Named(const std::set<char32_t>& letters) {
  std::u32string first;
  for (const char32_t letter : letters) {
    if (first.size() < kMostNamed) first.push_back(letter);
  }
  return Utf8(first) +
         (letters.size() > kMostNamed ? " and " + std::to_string(letters.size() - kMostNamed) + " more" : "");
}

void CheckText(const std::string& where, const std::string& text, const std::string& language, Fonts* fonts,
               std::vector<std::string>* warnings) {
  std::set<char32_t> missing, borrowed;
  std::string lender;
  for (const char32_t letter : CodePoints(text)) {
    if (IsInvisible(letter)) continue;
    const int font = fonts->FontFor(letter, language);
    if (font < 0) missing.insert(letter);
    if (font <= 0) continue;
    borrowed.insert(letter);
    lender = fonts->NameOf(font);
  }
  if (!missing.empty())
    warnings->push_back(
        where + " has letters that no font of this machine shows, and visitors will see boxes: " + Named(missing));
  if (!borrowed.empty())
    warnings->push_back(where + " has letters that the player shows only where a font for them is installed, as " +
                        OneLine(lender) + " is here: " + Named(borrowed));
}

}  // namespace

std::vector<std::string> WarningsOfWords(const TourData& tour, Fonts* fonts) {
  std::vector<std::string> warnings;
  for (const auto& [language, title] : tour.titles)
    CheckText("the title (" + language + ")", title, language, fonts, &warnings);
  for (size_t k = 0; k < tour.path.size(); ++k) {
    const TourStop& stop = tour.path[k];
    const std::string name = "stop " + std::to_string(k + 1);
    CheckText(name + "'s caption (" + tour.language + ")", stop.caption, tour.language, fonts, &warnings);
    for (const auto& [language, caption] : stop.captions)
      CheckText(name + "'s caption (" + language + ")", caption, language, fonts, &warnings);
    for (const auto& [language, sound] : stop.sounds) {
      const auto other = stop.captions.find(language);
      const bool written =
          language == tour.language ? !stop.caption.empty() : other != stop.captions.end() && !other->second.empty();
      if (!written)
        warnings.push_back(name + " has a sound (" + language +
                           ") without a caption: who cannot hear it learns nothing");
    }
  }
  return warnings;
}

}  // namespace flaneur
