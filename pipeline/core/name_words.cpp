#include "pipeline/core/name_words.h"

#include <cctype>

namespace flaneur {

std::vector<std::string> NameWords(std::string_view name) {
  std::vector<std::string> words;
  char before = 0;
  for (const char c : name) {
    const auto letter = static_cast<unsigned char>(c), last = static_cast<unsigned char>(before);
    before = c;
    if (!std::isalpha(letter)) continue;
    if (!std::isalpha(last) || (std::isupper(letter) && std::islower(last))) words.emplace_back();
    words.back() += static_cast<char>(std::tolower(letter));
  }
  return words;
}

}  // namespace flaneur
