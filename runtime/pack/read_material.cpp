#include "runtime/pack/read_material.h"

#include <utility>

#include "runtime/base/limits.h"
#include "runtime/base/pixels.h"

namespace flaneur {

std::string NameOf(const GltfFile& file, int image) {
  const Json& json = Element(file.json, "images", image);
  const std::string name = json.value("name", "");
  return "image " + std::to_string(image) + (name.empty() ? "" : " '" + name + "'");
}

int ImageView(const GltfFile& file, int image) {
  return Member(Element(file.json, "images", image), "bufferView").get<int>();
}

std::span<const uint8_t> ImageBytes(const GltfFile& file, int image) {
  return BufferView(file, ImageView(file, image));
}

PackImage ReadImageSize(const GltfFile& file, int index) {
  const auto size = DecodedSize(BeginningOfView(file, ImageView(file, index)));
  if (!size || size->width > kMostPictureSide_px || size->height > kMostPictureSide_px) {
    throw PackRefused("has " + NameOf(file, index) + " that is neither PNG nor JPEG, or too large");
  }
  PackImage image;
  image.width_px = size->width;
  image.height_px = size->height;
  return image;
}

PackImage ReadImage(const GltfFile& file, int index) {
  PackImage image = ReadImageSize(file, index);
  auto pixels = Decoded(ImageBytes(file, index));
  if (!pixels) throw PackRefused("has " + NameOf(file, index) + " that cannot be decoded; bake the tour again");
  image.rgba = std::move(pixels->rgba);
  return image;
}

PackMaterial ReadMaterial(const GltfFile& file, const Json& json) {
  PackMaterial material;
  material.name = json.value("name", "");
  material.double_sided = json.value("doubleSided", false);
  material.alpha_mask = json.value("alphaMode", "OPAQUE") != "OPAQUE";
  material.alpha_cutoff = json.value("alphaCutoff", 0.5f);
  static const Json kNothing = Json::object();
  const auto found = json.find("pbrMetallicRoughness");
  const Json& pbr = found != json.end() ? *found : kNothing;
  if (pbr.contains("baseColorFactor")) {
    const Json& c = pbr["baseColorFactor"];
    material.base_color = {c.at(0), c.at(1), c.at(2), c.at(3)};
  }
  if (pbr.contains("baseColorTexture")) {
    const Json& texture = Element(file.json, "textures", Member(pbr["baseColorTexture"], "index").get<int>());
    material.base_color_image = Index(texture, "source", Member(file.json, "images").size());
  }
  return material;
}

}  // namespace flaneur
