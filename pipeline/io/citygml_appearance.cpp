#include "pipeline/io/citygml_appearance.h"

#include <charconv>
#include <cmath>
#include <map>

#include "pipeline/io/image_beside.h"
#include "runtime/base/srgb.h"

namespace flaneur {
namespace {

std::vector<float> Numbers(const std::string& text) {
  std::vector<float> numbers;
  const char *at = text.data(), *end = at + text.size();
  while (true) {
    while (at < end && static_cast<unsigned char>(*at) <= ' ') ++at;
    float value = 0;
    const auto [next, problem] = std::from_chars(at, end, value);
    if (problem != std::errc() || !std::isfinite(value)) return numbers;
    numbers.push_back(value);
    at = next;
  }
}

std::string Trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t\r\n"), last = text.find_last_not_of(" \t\r\n");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::string WithoutHash(std::string_view reference) {
  if (!reference.empty() && reference[0] == '#') reference.remove_prefix(1);
  return std::string(reference);
}

// Beside the model or below its folder.
bool ReadImage(const std::filesystem::path& model, const std::filesystem::path& relative, Image* image) {
  if (relative.empty() || relative.is_absolute() || *relative.begin() == "..") return false;
  image->name = relative.string();
  return ReadImageFile(model.parent_path() / relative, image);
}

}  // namespace

bool CityAppearances::Enter(std::string_view name, std::string_view uri, std::string_view ring) {
  if (name == "ParameterizedTexture" || name == "X3DMaterial") {
    looks_.emplace_back();
    in_look_ = true;
  }
  if (!in_look_) return false;
  if (name == "target" && !uri.empty()) looks_.back().targets.push_back(WithoutHash(uri));
  ring_ = WithoutHash(ring);
  return name == "imageURI" || name == "diffuseColor" || (name == "target" && uri.empty()) ||
         (name == "textureCoordinates" && !ring.empty());
}

void CityAppearances::Leave(std::string_view name, const std::string& text) {
  if (!in_look_) return;
  if (name == "ParameterizedTexture" || name == "X3DMaterial") in_look_ = false;
  else if (name == "imageURI") looks_.back().image = Trimmed(text);
  else if (name == "target" && !text.empty()) looks_.back().targets.push_back(WithoutHash(Trimmed(text)));
  const std::vector<float> numbers = Numbers(text);
  if (name == "diffuseColor" && numbers.size() == 3)
    looks_.back().color = {LinearFromSrgb(numbers[0]), LinearFromSrgb(numbers[1]), LinearFromSrgb(numbers[2]), 1};
  if (name != "textureCoordinates" || numbers.size() % 2 != 0) return;
  std::vector<Vec2>& places = coordinates_[ring_];
  if (!places.empty()) return;  // another theme's
  for (size_t i = 0; i < numbers.size(); i += 2) places.push_back({numbers[i], 1 - numbers[i + 1]});
  if (!places.empty()) places.pop_back();
}

const std::vector<Vec2>* CityAppearances::TextureCoordinates(const std::string& ring, size_t points) const {
  const auto found = coordinates_.find(ring);
  return found == coordinates_.end() || found->second.size() != points ? nullptr : &found->second;
}

std::vector<int> AddMaterials(const std::filesystem::path& model, const std::vector<CityLook>& looks,
                              TownBuilder* builder, std::vector<std::string>* warnings) {
  std::vector<int> numbers;
  std::map<std::filesystem::path, int> of_image;  // one name may be spelled in many ways
  int unread = 0;
  std::string first_unread;
  for (const CityLook& look : looks) {
    Material material;
    material.double_sided = true;
    material.base_color = look.color;
    if (look.image.empty()) {
      material.name = "color_" + std::to_string(numbers.size());
      numbers.push_back(builder->AddMaterial(material, nullptr));
      continue;
    }
    const std::filesystem::path name = std::filesystem::path(look.image).lexically_normal();
    const auto [entry, is_new] = of_image.try_emplace(name, -1);
    Image image;
    if (is_new && ReadImage(model, name, &image)) {
      material.name = look.image;
      entry->second = builder->AddMaterial(material, &image);
    } else if (is_new && unread++ == 0) {
      first_unread = look.image;
    }
    numbers.push_back(entry->second);
  }
  if (unread > 0 && warnings)
    warnings->push_back(model.string() + ": " + std::to_string(unread) + " textures, such as '" + first_unread +
                        "', are no PNG, JPEG or WebP files beside the model; their surfaces are plain");
  return numbers;
}

}  // namespace flaneur
