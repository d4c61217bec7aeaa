#include "runtime/base/toml_table.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "runtime/base/color_text.h"
#include "runtime/base/file.h"
#include "runtime/base/text.h"
#include "runtime/base/toml_text.h"

namespace flaneur {
namespace {

constexpr double kMaxLength_m = 1e6;
constexpr double kMaxMap_m = 1e8;  // twice round the earth

// Two numbers in brackets, neither beyond `largest`; else false, and nothing is changed.
bool ReadPair(const toml::node& node, double largest, double* x, double* y) {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != 2) return false;
  const auto first = (*array)[0].value<double>(), second = (*array)[1].value<double>();
  if (!first || !second || !(std::abs(*first) <= largest && std::abs(*second) <= largest)) return false;
  *x = *first, *y = *second;
  return true;
}

}  // namespace

void TomlContext::Refuse(const toml::node* node, const std::string& why) {
  if (error) return;
  const std::string line =
      node != nullptr && node->source().begin.line > 0 ? ":" + std::to_string(node->source().begin.line) : "";
  error = Fail(path.string() + line + ": " + why);
}

Error ReadToml(const std::filesystem::path& path, toml::table* root) {
  std::string text;
  if (Error e = ReadTextFile(path, &text)) return e;
  return ParseToml(text, path.string(), root);
}

Error ParseToml(const std::string& text, const std::string& name, toml::table* root) {
  if (const int line = LineOfTooLongKey(text); line > 0)
    return Fail(name + ":" + std::to_string(line) + ": a key of more than 200 parts");
  try {
    *root = toml::parse(text, name);
    return Ok();
  } catch (const toml::parse_error& e) {
    const std::string why = OneLine(e.description());
    const bool encoded = why.find("utf-8") != std::string::npos;
    return Fail(name + ":" + std::to_string(e.source().begin.line) + ": not TOML: " + why +
                (encoded ? "; save it as UTF-8" : ""));
  }
}

TomlTable::TomlTable(TomlContext* context, const toml::table* table, std::string name)
    : context_(context), table_(table), name_(std::move(name)) {}

std::string TomlTable::Name(const char* key) const { return name_.empty() ? key : name_ + "." + key; }

const toml::node* TomlTable::Find(const char* key) {
  keys_.push_back(key);
  context_->known.push_back(Name(key));
  return table_ == nullptr ? nullptr : table_->get(key);
}

bool TomlTable::ReadNumber(const char* key, bool integer, double least, double most, double* number) {
  const toml::node* node = Find(key);
  if (node == nullptr) return false;
  if (!node->is_integer() && (integer || !node->is_floating_point())) {
    context_->Refuse(node, Name(key) + " must be a " + (integer ? "whole number" : "number"));
    return false;
  }
  *number = *node->value<double>();
  if (!(*number >= least && *number <= most)) {
    context_->Refuse(
        node, Name(key) + " is " + Compact(*number) + ", it must be from " + Compact(least) + " to " + Compact(most));
    return false;
  }
  return true;
}

void TomlTable::Angle(const char* stem, float* radians, double least_deg, double most_deg) {
  const std::string key = std::string(stem) + "_deg";
  double degrees = 0;
  if (ReadNumber(key.c_str(), false, least_deg, most_deg, &degrees)) {
    *radians = static_cast<float>(degrees) * kPi / 180;
  }
}

void TomlTable::Choice(const char* key, std::optional<std::string>* value, std::initializer_list<const char*> allowed) {
  std::string text;
  const toml::node* node = table_ == nullptr ? nullptr : table_->get(key);
  Text(key, &text);
  if (node == nullptr || !node->is_string()) return;
  std::string list;
  for (const char* a : allowed) {
    if (text == a) *value = text;
    list += (list.empty() ? "" : ", ") + std::string(a);
  }
  if (*value != text) context_->Refuse(node, Name(key) + " is '" + OneLine(text) + "', it must be one of: " + list);
}

void TomlTable::Choice(const char* key, std::string* value, std::initializer_list<const char*> allowed) {
  std::optional<std::string> choice;
  Choice(key, &choice, allowed);
  if (choice) *value = *choice;
}

void TomlTable::Text(const char* key, std::string* value) {
  const toml::node* node = Find(key);
  if (node == nullptr) return;
  if (!node->is_string()) return context_->Refuse(node, Name(key) + " must be text in quotes");
  TakeText(*node, key, value);
}

void TomlTable::TakeText(const toml::node& node, const char* key, std::string* value) {
  std::string text = *node.value<std::string>();
  if (text.size() > kMostText_bytes)
    return context_->Refuse(&node, Name(key) + " is text of more than " + std::to_string(kMostText_bytes) + " bytes");
  *value = std::move(text);
}

void TomlTable::Flag(const char* key, bool* value) {
  const toml::node* node = Find(key);
  if (node == nullptr) return;
  if (!node->is_boolean()) return context_->Refuse(node, Name(key) + " must be true or false");
  *value = *node->value<bool>();
}

void TomlTable::Numbers(const char* key, std::vector<float>* values, double least, double most) {
  const toml::node* node = Find(key);
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  std::vector<float> read;
  for (size_t i = 0; array != nullptr && i < array->size(); ++i) {
    const auto number = (*array)[i].value<double>();
    if (!number || !(*number >= least && *number <= most)) {
      return context_->Refuse(node, Name(key) + " must hold numbers from " + Compact(least) + " to " + Compact(most));
    }
    read.push_back(static_cast<float>(*number));
  }
  if (array == nullptr) return context_->Refuse(node, Name(key) + " must be a list of numbers");
  *values = std::move(read);
}

void TomlTable::Texts(const char* key, std::vector<std::string>* values) {
  const toml::node* node = Find(key);
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  if (array == nullptr) return context_->Refuse(node, Name(key) + " must be a list of texts");
  values->clear();
  for (const toml::node& element : *array) {
    if (!element.is_string()) return context_->Refuse(&element, Name(key) + " must be a list of texts");
    TakeText(element, key, &values->emplace_back());
  }
}

void TomlTable::Color(const char* key, Vec3* value) {
  const toml::node* node = Find(key);
  if (node == nullptr) return;
  const auto color = node->is_string() ? ColorFromText(*node->value<std::string>()) : std::nullopt;
  if (!color) return context_->Refuse(node, Name(key) + " must be a colour such as \"#2f4f8f\"");
  *value = *color;
}

void TomlTable::Colors(const char* key, std::vector<Vec3>* values) {
  std::vector<std::string> texts;
  Texts(key, &texts);
  values->clear();
  for (const std::string& text : texts) {
    const auto color = ColorFromText(text);
    if (!color)
      return context_->Refuse(table_->get(key),
                              Name(key) + ": '" + OneLine(text) + "' must be a colour such as \"#2f4f8f\"");
    values->push_back(*color);
  }
}

void TomlTable::Point(const char* key, Vec2* value) {
  std::vector<float> numbers{value->x, value->y};
  const toml::node* node = table_ == nullptr ? nullptr : table_->get(key);
  Numbers(key, &numbers, -kMaxLength_m, kMaxLength_m);
  if (numbers.size() != 2) return context_->Refuse(node, Name(key) + " must be [x, y] in metres");
  *value = {numbers[0], numbers[1]};
}

void TomlTable::TownPoint(const char* key, Vec2* value) {
  double x = static_cast<double>(value->x), y = static_cast<double>(value->y);
  const toml::node* node = Find(key);
  if (node != nullptr && !ReadPair(*node, kMaxMap_m, &x, &y))
    return context_->Refuse(node, Name(key) + " must be [x, y] in metres");
  *value = {static_cast<float>(x), static_cast<float>(y)};
}

void TomlTable::Points(const char* key, std::vector<Vec2>* values) { TakePoints(key, kMaxLength_m, values); }
void TomlTable::TownPoints(const char* key, std::vector<Vec2>* values) { TakePoints(key, kMaxMap_m, values); }

void TomlTable::TakePoints(const char* key, double largest_m, std::vector<Vec2>* values) {
  const toml::node* node = Find(key);
  if (node == nullptr) return;
  const toml::array* points = node->as_array();
  bool sound = points != nullptr;
  for (size_t i = 0; sound && i < points->size(); ++i) {
    double x = 0, y = 0;
    sound = ReadPair((*points)[i], largest_m, &x, &y);
    if (sound) values->push_back({static_cast<float>(x), static_cast<float>(y)});
  }
  if (!sound) context_->Refuse(node, Name(key) + " must be a list of [x, y] in metres");
}

void TomlTable::MapPoint(const char* key, double* east_m, double* north_m) {
  const toml::node* node = Find(key);
  if (node == nullptr || ReadPair(*node, kMaxMap_m, east_m, north_m)) return;
  context_->Refuse(node, Name(key) + " must be [east, north] in metres of the map");
}

void TomlTable::File(const char* key, std::filesystem::path* value) {
  std::string text;
  Text(key, &text);
  if (!text.empty()) *value = Beside(key, text);
}

std::filesystem::path TomlTable::Beside(const char* key, const std::string& file) {
  const toml::node* node = table_ != nullptr ? table_->get(key) : nullptr;
  const std::string line = node != nullptr ? ":" + std::to_string(node->source().begin.line) : "";
  const std::filesystem::path path = (context_->path.parent_path() / file).lexically_normal();
  context_->files.emplace_back(path, context_->path.string() + line + ": " + Name(key));
  return path;
}

void TomlTable::Translations(const char* key, const std::string& own, std::map<std::string, std::string>* texts) {
  const toml::node* node = Find(key);
  if (node == nullptr) return;
  const char* const wanted =
      " must be text in quotes, or a table of texts by language such as { en = \"...\", de = \"...\" }";
  if (node->is_string()) {
    TakeText(*node, key, &(*texts)[own]);
    return;
  }
  if (!node->is_table()) return context_->Refuse(node, Name(key) + wanted);
  for (const auto& [language, text] : *node->as_table()) {
    if (!text.is_string() || language.str().empty()) return context_->Refuse(&text, Name(key) + wanted);
    TakeText(text, key, &(*texts)[std::string(language.str())]);
  }
}

void TomlTable::Json(const char* key, std::string* json) {
  const toml::node* node = Find(key);
  if (node == nullptr) return;
  if (!node->is_table()) return context_->Refuse(node, Name(key) + " must be a table");
  std::ostringstream out;
  out << toml::json_formatter(*node->as_table());
  *json = out.str();
}

TomlTable TomlTable::Table(const char* key) {
  const toml::node* node = table_ == nullptr ? nullptr : table_->get(key);
  keys_.push_back(key);
  if (node != nullptr && !node->is_table()) context_->Refuse(node, Name(key) + " must be a table");
  return {context_, node == nullptr ? nullptr : node->as_table(), Name(key)};
}

std::vector<TomlTable> TomlTable::Tables(const char* key, size_t most) {
  const toml::node* node = table_ == nullptr ? nullptr : table_->get(key);
  keys_.push_back(key);
  std::vector<TomlTable> tables;
  if (node == nullptr) return tables;
  const toml::array* array = node->as_array();
  if (array == nullptr) {
    context_->Refuse(node, "write [[" + Name(key) + "]] with two brackets: there may be several");
    return tables;
  }
  if (array->size() > most) {
    context_->Refuse(
        node, std::to_string(array->size()) + " tables of [[" + Name(key) + "]], there may be " + std::to_string(most));
    return tables;
  }
  for (const toml::node& element : *array) {
    if (element.is_table()) tables.emplace_back(context_, element.as_table(), Name(key));
    else context_->Refuse(&element, Name(key) + " must be a list of tables");
  }
  return tables;
}

void TomlTable::Refuse(const std::string& why) { context_->Refuse(table_, why); }

void TomlTable::Finish() {
  if (table_ == nullptr) return;
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    if (std::find(keys_.begin(), keys_.end(), name) != keys_.end()) continue;
    context_->Refuse(&node, "unknown key '" + OneLine(name) + "'" + (name_.empty() ? "" : " in [" + name_ + "]") +
                                DidYouMean(name, keys_));
  }
}

}  // namespace flaneur
