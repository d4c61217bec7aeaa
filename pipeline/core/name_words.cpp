#include "pipeline/core/name_words.h"

#include <cctype>

namespace flaneur {

namespace {

// Of UTF-8 too, all of whose bytes above ASCII count.
bool IsLetter(unsigned char c) { return c >= 0x80 || std::isalpha(c); }

}  // namespace

std::vector<std::string> NameWords(std::string_view name) {
  std::vector<std::string> words;
  char before = 0;
  for (const char c : name) {
    const auto letter = static_cast<unsigned char>(c), last = static_cast<unsigned char>(before);
    before = c;
    if (!IsLetter(letter)) continue;
    const bool capital = std::isupper(letter) && (std::islower(last) || last >= 0x80);
    if (!IsLetter(last) || capital) words.emplace_back();
    words.back() += static_cast<char>(std::tolower(letter));
  }
  return words;
}

}  // namespace flaneur
