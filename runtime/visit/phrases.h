// What the player itself says to the visitor. A language is one file in runtime/visit/words.
#pragma once
#include <initializer_list>
#include <string>
#include <vector>

#include "runtime/visit/player_settings.h"

namespace flaneur {

enum class Phrase {
#define PHRASE(phrase, name) phrase,
#include "runtime/visit/phrase_list.h"
#undef PHRASE
  kCount
};
inline constexpr const char* kPhraseNames[] = {
#define PHRASE(phrase, name) name,
#include "runtime/visit/phrase_list.h"
#undef PHRASE
};

// In English where there is nothing in this language, such as "de" or "de-AT".
const char* Say(Phrase phrase, const std::string& language);
const char* NameOf(Action action, const std::string& language);
// The phrase with these in place of its %s, one after the other.
std::string Say(Phrase phrase, const std::string& language, std::initializer_list<std::string> put_in);
// As it stands on a keyboard of that language: "Space", "Leertaste"; those of the keypad as "Num 5".
std::string KeyName(const std::string& label, const std::string& language);

// Of the player's own words, English first.
const std::vector<std::string>& PhraseLanguages();
// What is wrong with its file: words that are missing or not known, or places for what is put in. For tests.
std::vector<std::string> FaultsOfWords(const std::string& language);
// In itself, such as "Deutsch" for "de"; the code where it is not known.
std::string LanguageName(const std::string& language);

}  // namespace flaneur
