#include "runtime/visit/phrases.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "runtime/visit/word_files.h"

namespace flaneur {
namespace {

constexpr const char* kFallback = "en";
constexpr const char* kKeypad = "Keypad ";
constexpr const char* kPlace = "%s";

struct Words {
  std::string name;
  std::array<std::string, static_cast<size_t>(Phrase::kCount)> phrases;
  std::array<std::string, kActions> actions;
  std::map<std::string, std::string> keys;  // by their English labels
  std::vector<std::string> faults;
};

template <size_t N>
void Take(const toml::table& file, const char* part, const char* const (&names)[N], std::array<std::string, N>* texts,
          std::vector<std::string>* faults) {
  const toml::table* table = file[part].as_table();
  for (size_t k = 0; k < N; ++k) {
    if (table != nullptr) (*texts)[k] = (*table)[names[k]].value_or(std::string());
    if ((*texts)[k].empty()) faults->push_back(std::string(part) + "." + names[k] + " is missing");
  }
  if (table == nullptr) return;
  for (const auto& [key, value] : *table) {
    if (std::find(std::begin(names), std::end(names), key.str()) == std::end(names))
      faults->push_back(std::string(part) + "." + std::string(key.str()) + " is not known");
  }
}

Words Read(const char* text) {
  Words words;
  const toml::table file = toml::parse(text);
  words.name = file["name"].value_or(std::string());
  Take(file, "phrases", kPhraseNames, &words.phrases, &words.faults);
  Take(file, "actions", kActionNames, &words.actions, &words.faults);
  if (const toml::table* keys = file["keys"].as_table()) {
    for (const auto& [key, value] : *keys) words.keys[std::string(key.str())] = value.value_or(std::string());
  }
  return words;
}

const std::map<std::string, Words>& AllWords() {
  static const std::map<std::string, Words> all = [] {
    std::map<std::string, Words> read;
    for (const WordFile& file : WordFiles()) read[file.language] = Read(file.text);
    return read;
  }();
  return all;
}

// Of "de-AT" those of "de".
const Words* Find(const std::string& language) {
  const auto found = AllWords().find(language.substr(0, language.find_first_of("-_")));
  return found == AllWords().end() ? nullptr : &found->second;
}

const Words& In(const std::string& language) {
  const Words* words = Find(language);
  return words != nullptr ? *words : AllWords().at(kFallback);
}

const char* OrFallback(const std::string& text, const std::string& fallback) {
  return text.empty() ? fallback.c_str() : text.c_str();
}

size_t Places(const std::string& text) {
  size_t count = 0;
  for (size_t at = text.find(kPlace); at != std::string::npos; at = text.find(kPlace, at + 2)) ++count;
  return count;
}

// Of tours whose language the player does not speak.
constexpr std::pair<const char*, const char*> kLanguageNames[] = {
    {"ar", "العربية"},    {"bg", "Български"},   {"ca", "Català"},     {"cs", "Čeština"},       {"da", "Dansk"},
    {"el", "Ελληνικά"},   {"et", "Eesti"},       {"fa", "فارسی"},      {"fi", "Suomi"},         {"he", "עברית"},
    {"hi", "हिन्दी"},      {"hr", "Hrvatski"},    {"hu", "Magyar"},     {"ja", "日本語"},        {"ko", "한국어"},
    {"la", "Latina"},     {"lt", "Lietuvių"},    {"lv", "Latviešu"},   {"nds", "Plattdüütsch"}, {"nl", "Nederlands"},
    {"no", "Norsk"},      {"pl", "Polski"},      {"pt", "Português"},  {"ro", "Română"},        {"ru", "Русский"},
    {"sk", "Slovenčina"}, {"sl", "Slovenščina"}, {"sv", "Svenska"},    {"th", "ไทย"},           {"tr", "Türkçe"},
    {"uk", "Українська"}, {"ur", "اردو"},        {"vi", "Tiếng Việt"}, {"yi", "ייִדיש"},         {"zh", "中文"}};

}  // namespace

const char* Say(Phrase phrase, const std::string& language) {
  const auto k = static_cast<size_t>(phrase);
  return OrFallback(In(language).phrases[k], AllWords().at(kFallback).phrases[k]);
}

std::string Say(Phrase phrase, const std::string& language, std::initializer_list<std::string> put_in) {
  std::string text = Say(phrase, language);
  size_t from = 0;
  for (const std::string& part : put_in) {
    const size_t at = text.find(kPlace, from);
    if (at == std::string::npos) break;
    text.replace(at, 2, part);
    from = at + part.size();
  }
  return text;
}

const char* NameOf(Action action, const std::string& language) {
  const auto k = static_cast<size_t>(action);
  return OrFallback(In(language).actions[k], AllWords().at(kFallback).actions[k]);
}

std::string KeyName(const std::string& label, const std::string& language) {
  if (label.rfind(kKeypad, 0) == 0) {
    const std::string key = label.substr(std::string(kKeypad).size());
    return "Num " + (key == "Subtract" ? "-" : key == "Add" ? "+" : KeyName(key, language));
  }
  const auto& keys = In(language).keys;
  const auto found = keys.find(label);
  return found == keys.end() ? label : found->second;
}

const std::vector<std::string>& PhraseLanguages() {
  static const std::vector<std::string> languages = [] {
    std::vector<std::string> all{kFallback};
    for (const auto& [language, words] : AllWords()) {
      if (language != kFallback) all.push_back(language);
    }
    return all;
  }();
  return languages;
}

std::vector<std::string> FaultsOfWords(const std::string& language) {
  const Words& words = In(language);
  const Words& english = AllWords().at(kFallback);
  std::vector<std::string> faults = words.faults;
  if (words.name.empty()) faults.push_back("name is missing");
  for (size_t k = 0; k < words.phrases.size(); ++k) {
    if (Places(words.phrases[k]) != Places(english.phrases[k]))
      faults.push_back(std::string("phrases.") + kPhraseNames[k] + " has another number of %s");
  }
  return faults;
}

std::string LanguageName(const std::string& language) {
  if (const Words* words = Find(language); words != nullptr && !words->name.empty()) return words->name;
  for (const auto& [code, name] : kLanguageNames) {
    if (language == code) return name;
  }
  return language;
}

}  // namespace flaneur
