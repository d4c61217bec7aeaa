// The look of CityGML's surfaces: its appearance module.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "pipeline/io/town_builder.h"

namespace flaneur {

// One texture or colour and the ids of what wears it.
struct CityLook {
  std::string image;       // file beside the model; empty: a colour
  Vec4 color{1, 1, 1, 1};  // linear
  std::vector<std::string> targets;
};

// Collects appearances as elements come by. Texture coordinates belong to rings, by their ids.
class CityAppearances {
 public:
  // Whether the text of the element is wanted; `uri` and `ring` are its attributes, or empty.
  bool Enter(std::string_view name, std::string_view uri, std::string_view ring);
  void Leave(std::string_view name, const std::string& text);

  bool empty() const { return looks_.empty(); }
  const std::vector<CityLook>& looks() const { return looks_; }
  // Of a ring with so many points, without a repeated last one; null where there are none that fit.
  const std::vector<Vec2>* TextureCoordinates(const std::string& ring, size_t points) const;

 private:
  std::vector<CityLook> looks_;
  bool in_look_ = false;
  std::string ring_;
  std::unordered_map<std::string, std::vector<Vec2>> coordinates_;
};

// The builder's numbers of the looks' materials, -1 where an image cannot be read: one warning for all of those.
std::vector<int> AddMaterials(const std::filesystem::path& model, const std::vector<CityLook>& looks,
                              TownBuilder* builder, std::vector<std::string>* warnings);

}  // namespace flaneur
