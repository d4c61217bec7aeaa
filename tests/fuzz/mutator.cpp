#include "tests/fuzz/mutator.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

namespace flaneur::fuzz {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr size_t kGlbHead_bytes = 20;

std::string Whole(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Lines of libFuzzer's dictionaries: name="word", with \" and \\ and \xAB.
std::string WordOf(const std::string& line) {
  const size_t first = line.find('"'), last = line.rfind('"');
  std::string word;
  for (size_t i = first + 1; first != std::string::npos && i < last; ++i) {
    if (line[i] != '\\') {
      word += line[i];
    } else if (line[i + 1] == 'x') {
      word += static_cast<char>(std::stoi(line.substr(i + 2, 2), nullptr, 16));
      i += 3;
    } else {
      word += line[++i];
    }
  }
  return word;
}

uint32_t WordAt(const std::string& bytes, size_t at) {
  uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

void PutWord(std::string* bytes, size_t at, size_t value) {
  const auto word = static_cast<uint32_t>(value);
  std::memcpy(bytes->data() + at, &word, sizeof word);
}

const char* const kNumbers[] = {
    "0",    "-1",     "1",    "0.5",        "1e308", "-1e308",     "1e-308",     "NaN",
    "1e38", "1e9",    "-1e9", "4294967295", "65535", "2147483648", "2147483647", "99999999999999999999",
    "1e-9", "100000", "255",  "1000"};

// Every value of the JSON, to choose from.
void Collect(Json* json, std::vector<Json*>* all) {
  all->push_back(json);
  if (!json->is_structured()) return;
  for (auto& item : *json) Collect(&item, all);
}

Json Odd(size_t which) {
  switch (which % 16) {
    case 0:
      return nullptr;
    case 1:
      return Json::array();
    case 2:
      return Json::object();
    case 3:
      return "text";
    case 4:
      return std::string(30000, 'x');
    default:
      return Json::parse(kNumbers[which % std::size(kNumbers)], nullptr, false).is_discarded()
                 ? Json(-1)
                 : Json::parse(kNumbers[which % std::size(kNumbers)], nullptr, false);
  }
}

std::string Dumped(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace

Material MaterialOf(const Target& target, const fs::path& source) {
  Material material;
  std::vector<fs::path> files;
  std::error_code ec;
  for (const auto& entry : fs::directory_iterator(source / "tests/data/fuzz" / target.name, ec))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const char* seed : target.seeds) {
    if (seed != nullptr) files.push_back(source / seed);
  }
  for (const fs::path& file : files) material.seeds.push_back(Whole(file));
  std::ifstream dictionary(source / "tests/fuzz/dictionaries" / (std::string(target.name) + ".dict"));
  for (std::string line; std::getline(dictionary, line);) {
    if (!line.empty() && line[0] != '#') material.words.push_back(WordOf(line));
  }
  return material;
}

Mutator::Mutator(const Target& target, const Material& material, uint64_t seed)
    : target_(target), material_(material), random_(seed) {}

std::string Mutator::Next() {
  return material_.seeds.empty() ? std::string() : Changed(material_.seeds[Below(material_.seeds.size())]);
}

std::string Mutator::Changed(std::string file) {
  const bool structured = target_.structure == Structure::kJson || target_.structure == Structure::kGlb;
  if (structured && Below(4) != 0) {
    file = target_.structure == Structure::kGlb ? ChangedGlb(file) : ChangedJson(file);
    if (Below(8) != 0) return file.substr(0, kMostInput_bytes);
  }
  for (size_t i = 0, count = 1 + Below(6); i < count && !file.empty(); ++i) ChangeBytes(&file);
  return file.substr(0, kMostInput_bytes);
}

void Mutator::ChangeBytes(std::string* text) {
  const size_t at = Below(text->size()), length = std::min(1 + Below(60), text->size() - at);
  switch (Below(10)) {
    case 0:
      (*text)[at] = static_cast<char>((*text)[at] ^ (1 << Below(8)));
      break;
    case 1:
      (*text)[at] = static_cast<char>(Below(256));
      break;
    case 2:
      text->erase(at, length);
      break;
    case 3:
      text->insert(Below(text->size()), text->substr(at, length));
      break;
    case 4:
      if (Below(4) == 0) text->resize(at);
      break;
    case 5: {  // of another file
      const std::string& other = material_.seeds[Below(material_.seeds.size())];
      if (!other.empty()) text->insert(at, other.substr(Below(other.size()), 1 + Below(400)));
      break;
    }
    case 6:
      if (!material_.words.empty()) text->insert(at, material_.words[Below(material_.words.size())]);
      break;
    case 7: {  // the same again and again
      const std::string part = text->substr(at, length);
      std::string many;
      for (size_t k = 0, times = size_t{1} << Below(14); k < times && many.size() < 200000; ++k) many += part;
      text->insert(at, many);
      break;
    }
    default:
      if (target_.structure == Structure::kBytes && at + 4 <= text->size()) {
        static const uint32_t kWords[] = {0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x10000, 0xFFFF};
        PutWord(text, at, kWords[Below(std::size(kWords))]);
      } else {
        ReplaceNumber(at, text);
      }
      break;
  }
}

// The next number by one that is hard to bear.
void Mutator::ReplaceNumber(size_t from, std::string* text) {
  const size_t begin = text->find_first_of("0123456789", from);
  if (begin == std::string::npos) return;
  const size_t end = std::min(text->find_first_not_of("0123456789.eE+-", begin), text->size());
  text->replace(begin, end - begin, kNumbers[Below(std::size(kNumbers))]);
}

std::string Mutator::ChangedJson(const std::string& text) {
  Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) return text;
  for (size_t i = 0, count = 1 + Below(5); i < count; ++i) {
    std::vector<Json*> all;
    Collect(&json, &all);
    Json* at = all[Below(all.size())];
    const Json other = *all[Below(all.size())];
    switch (Below(8)) {
      case 0:
        if (at->is_array() && !at->empty()) at->erase(Below(at->size()));
        else if (at->is_object() && !at->empty())
          at->erase(std::next(at->begin(), static_cast<long>(Below(at->size()))));
        break;
      case 1:  // an element many times over
        if (at->is_array() && !at->empty()) {
          const Json element = (*at)[Below(at->size())];
          const size_t bytes = 1 + Dumped(element).size();
          for (size_t k = 0, times = size_t{1} << Below(12); k < times && k * bytes < 300000; ++k)
            at->push_back(element);
        }
        break;
      case 2:
        if (Dumped(other).size() < 100000) *at = other;
        break;
      case 3:
        for (size_t k = 0, times = Below(2) == 0 ? 3 : Below(300); k < times; ++k) *at = Json::array({std::move(*at)});
        break;
      case 4:
        if (!material_.words.empty()) {
          const std::string& word = material_.words[Below(material_.words.size())];
          if (at->is_object()) (*at)[word] = other;
          else if (at->is_string()) *at = word;
        }
        break;
      case 5:
        if (at->is_number_integer()) *at = static_cast<int64_t>(Below(40));
        break;
      default:
        *at = Odd(Below(1000));
        break;
    }
  }
  return Dumped(json);
}

// The JSON of its first chunk, or bytes of the other; the lengths are set right, so that readers go on to what is in
// it.
std::string Mutator::ChangedGlb(const std::string& file) {
  if (file.size() < kGlbHead_bytes || WordAt(file, 12) > file.size() - kGlbHead_bytes) return file;
  const size_t json_bytes = WordAt(file, 12);
  std::string json = file.substr(kGlbHead_bytes, json_bytes), rest = file.substr(kGlbHead_bytes + json_bytes);
  if (Below(4) != 0) json = ChangedJson(json);
  if (Below(3) == 0 && rest.size() > 8) {
    for (size_t k = 0, count = 1 + Below(8); k < count; ++k) {
      const size_t at = 8 + Below(rest.size() - 8);
      static const char* const kFloats[] = {"\x00\x00\xc0\x7f", "\x00\x00\x80\x7f", "\xff\xff\x7f\x7f",
                                            "\xff\xff\xff\xff"};
      if (Below(2) == 0 && at + 4 <= rest.size()) rest.replace(at, 4, std::string(kFloats[Below(4)], 4));
      else rest[at] = static_cast<char>(Below(256));
    }
  }
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string out = file.substr(0, kGlbHead_bytes) + json + rest;
  PutWord(&out, 8, out.size());
  PutWord(&out, 12, json.size());
  return out;
}

}  // namespace flaneur::fuzz
