// Reads one table of a TOML file field by field, and then says which keys nobody asked for.
#pragma once
#include <toml++/toml.h>

#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/limits.h"
#include "runtime/base/math.h"

namespace flaneur {

// What all tables of one file share: the first error met, and the names of all fields.
struct TomlContext {
  std::filesystem::path path;
  Error error;
  std::vector<std::string> known;                                    // "section.key"
  std::vector<std::pair<std::filesystem::path, std::string>> files;  // that it names, each with "FILE:LINE: key"

  void Refuse(const toml::node* node, const std::string& why);  // keeps the first
};

// Errors: unreadable, not TOML; FILE:LINE in front.
Error ReadToml(const std::filesystem::path& path, toml::table* root);

class TomlTable {
 public:
  // `table` may be null: then every field keeps its default. `name` is how messages call it.
  TomlTable(TomlContext* context, const toml::table* table, std::string name);

  template <typename T>
  void Number(const char* key, T* value, double least, double most) {
    double number = static_cast<double>(*value);
    if (ReadNumber(key, std::is_integral_v<T>, least, most, &number)) *value = static_cast<T>(number);
  }
  template <typename T>
  void Number(const char* key, std::optional<T>* value, double least, double most) {
    double number = 0;
    if (ReadNumber(key, std::is_integral_v<T>, least, most, &number)) *value = static_cast<T>(number);
  }
  void Angle(const char* stem, float* radians, double least_deg, double most_deg);
  void Choice(const char* key, std::string* value, std::initializer_list<const char*> allowed);
  void Choice(const char* key, std::optional<std::string>* value, std::initializer_list<const char*> allowed);
  void Text(const char* key, std::string* value);
  void Flag(const char* key, bool* value);
  void Numbers(const char* key, std::vector<float>* values, double least, double most);
  void Texts(const char* key, std::vector<std::string>* values);
  void Color(const char* key, Vec3* value);  // "#rrggbb"; sRGB, 0 to 1
  void Colors(const char* key, std::vector<Vec3>* values);
  void Point(const char* key, Vec2* value);
  // As large as coordinates of a map are, which floats hold to half a metre.
  void TownPoint(const char* key, Vec2* value);
  void Points(const char* key, std::vector<Vec2>* values);
  void TownPoints(const char* key, std::vector<Vec2>* values);
  void MapPoint(const char* key, double* east_m, double* north_m);  // of any size, in full precision
  void File(const char* key, std::filesystem::path* value);         // relative to the file's folder
  // Texts by language: one text, which is in `own`, or a table of them.
  void Translations(const char* key, const std::string& own, std::map<std::string, std::string>* texts);
  void Json(const char* key, std::string* json);                           // a table, as a JSON object
  std::filesystem::path Beside(const char* key, const std::string& file);  // the same of a name that was read otherwise
  // The table, or array of tables, under the key; of these so many at most.
  TomlTable Table(const char* key);
  std::vector<TomlTable> Tables(const char* key, size_t most = kMostTables);

  bool Has(const char* key) const { return table_ != nullptr && table_->contains(key); }
  // Something is wrong with this table as a whole.
  void Refuse(const std::string& why);
  // Refuses keys that no field above read. Call last.
  void Finish();

 private:
  const toml::node* Find(const char* key);
  void TakePoints(const char* key, double largest_m, std::vector<Vec2>* values);
  void TakeText(const toml::node& node, const char* key, std::string* value);  // no longer than kMostText_bytes
  bool ReadNumber(const char* key, bool integer, double least, double most, double* number);
  std::string Name(const char* key) const;

  TomlContext* context_;
  const toml::table* table_;
  std::string name_;
  std::vector<std::string> keys_;
};

}  // namespace flaneur
