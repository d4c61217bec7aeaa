#include "pipeline/cli/check_words.h"

#include <map>
#include <set>
#include <utility>

#include "pipeline/core/listed.h"
#include "runtime/base/text.h"
#include "runtime/text/unicode.h"

namespace flaneur {
namespace {

constexpr size_t kMostNamed = 8;   // letters, in one line
constexpr size_t kMostPlaces = 4;  // likewise

std::string Named(const std::set<char32_t>& letters) {
  std::u32string first;
  for (const char32_t letter : letters) {
    if (first.size() < kMostNamed) first.push_back(letter);
  }
  return Utf8(first) +
         (letters.size() > kMostNamed ? " and " + std::to_string(letters.size() - kMostNamed) + " more" : "");
}

// All that is written in one language: where, and what.
using Words = std::vector<std::pair<std::string, std::string>>;
using WordsByLanguage = std::map<std::string, Words>;

void Add(const std::string& where, const TextsByLanguage& texts, WordsByLanguage* all) {
  for (const auto& [language, text] : texts) (*all)[language].emplace_back(where, text);
}

WordsByLanguage AllWords(const TourData& tour) {
  WordsByLanguage all;
  const auto numbered = [](const char* what, size_t index) { return what + std::to_string(index + 1); };
  Add("the title", tour.titles, &all);
  for (size_t k = 0; k < tour.path.size(); ++k) {
    Add(numbered("stop ", k), {{tour.language, tour.path[k].caption}}, &all);
    Add(numbered("stop ", k), tour.path[k].captions, &all);
  }
  for (size_t k = 0; k < tour.hotspots.size(); ++k) {
    Add(numbered("hotspot ", k), tour.hotspots[k].titles, &all);
    Add(numbered("hotspot ", k), tour.hotspots[k].texts, &all);
  }
  for (const Street& street : tour.streets) Add("a street's name", street.names, &all);
  Add("the thanks", tour.thanks, &all);
  Add("the photo's line", tour.photo.lines, &all);
  return all;
}

// Letters of one fault, and where they stand.
struct Fault {
  std::set<char32_t> letters;
  std::vector<std::string> places;

  void Note(char32_t letter, const std::string& where) {
    letters.insert(letter);
    if (places.empty() || places.back() != where) places.push_back(where);
  }
};

void CheckLetters(const std::string& language, const Words& words, Fonts* fonts, std::vector<std::string>* warnings) {
  Fault missing, borrowed;
  std::string lender;
  for (const auto& [where, text] : words) {
    for (const char32_t letter : CodePoints(text)) {
      if (IsInvisible(letter)) continue;
      const int font = fonts->FontFor(letter, language);
      if (font < 0) missing.Note(letter, where);
      if (font <= 0) continue;
      borrowed.Note(letter, where);
      lender = fonts->NameOf(font);
    }
  }
  const std::string in = "the tour's words in '" + OneLine(language) + "' have letters that ";
  if (!missing.letters.empty())
    warnings->push_back(in + "no font of this machine shows, and visitors will see boxes: " + Named(missing.letters) +
                        " (" + Listed(missing.places, kMostPlaces) + ")");
  if (!borrowed.letters.empty())
    warnings->push_back(in + "the player shows only where a font for them is installed, as " + OneLine(lender) +
                        " is here: " + Named(borrowed.letters) + " (" + Listed(borrowed.places, kMostPlaces) + ")");
}

bool Holds(const TextsByLanguage& texts, const std::string& language) {
  const auto found = texts.find(language);
  return found != texts.end() && !found->second.empty();
}

}  // namespace

std::vector<std::string> WarningsOfWords(const TourData& tour, Fonts* fonts) {
  std::vector<std::string> warnings;
  for (const auto& [language, words] : AllWords(tour)) CheckLetters(language, words, fonts, &warnings);
  for (size_t k = 0; k < tour.path.size(); ++k) {
    const TourStop& stop = tour.path[k];
    for (const auto& [language, sound] : stop.sounds) {
      const bool written = language == tour.language ? !stop.caption.empty() : Holds(stop.captions, language);
      if (!written)
        warnings.push_back("stop " + std::to_string(k + 1) + " has a sound (" + language +
                           ") without a caption: who cannot hear it learns nothing");
    }
  }
  return warnings;
}

}  // namespace flaneur
