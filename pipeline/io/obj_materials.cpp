#include "pipeline/io/obj_materials.h"

#include <algorithm>
#include <utility>

#include "pipeline/core/child_policy.h"
#include "pipeline/core/obj_files.h"
#include "pipeline/io/image_beside.h"
#include "runtime/base/file.h"
#include "runtime/base/srgb.h"

namespace flaneur {
namespace fs = std::filesystem;
namespace {

// From 0 to 1, as many as there are, up to three.
std::vector<float> Shares(std::string_view text) {
  std::vector<float> shares = TakeNumbers(&text);
  for (float& share : shares) share = std::clamp(share, 0.0f, 1.0f);
  return shares;
}

}  // namespace

void ObjMaterials::AddLibraries(const fs::path& obj, std::string_view named) {
  for (const fs::path& library : ObjLibraries(obj, named)) AddLibrary(library);
}

void ObjMaterials::AddLibrary(const fs::path& library) {
  std::string text;
  if (CheckWithinRoots(library) || ReadTextFile(library, &text)) {
    lost_libraries_.push_back(library.filename().string());
    return;
  }
  Entry* entry = nullptr;
  ForObjLines(text, [&](std::string_view key, std::string_view rest) {
    if (key == "newmtl") {
      entry = &entries_[std::string(rest)];
      *entry = {};
      entry->material.name = rest;
      entry->material.double_sided = true;
    }
    if (entry == nullptr) return;
    Vec4& color = entry->material.base_color;
    if (key == "Kd") {
      const std::vector<float> rgb = Shares(rest);
      if (rgb.size() == 3) color = {LinearFromSrgb(rgb[0]), LinearFromSrgb(rgb[1]), LinearFromSrgb(rgb[2]), color.w};
    } else if (key == "d" || key == "Tr") {
      const std::vector<float> alpha = Shares(rest);
      if (!alpha.empty()) color.w = key == "d" ? alpha[0] : 1 - alpha[0];
    } else if (key == "map_Kd") {
      const ObjPicture picture = ReadObjPicture(rest);
      entry->picture = BesideModel(library.parent_path(), picture.file);
      entry->look.uv_scale = picture.scale;
      entry->look.uv_offset = picture.offset;
    } else if (key == "map_d") {
      entry->material.alpha = Material::Alpha::kMask;
    }
  });
}

FaceLook ObjMaterials::Use(const std::string& name, TownBuilder* builder) {
  const auto found = entries_.find(name);
  if (found == entries_.end()) return {};
  Entry& entry = found->second;
  if (std::exchange(entry.used, true)) return entry.look;
  Material& material = entry.material;
  if (material.base_color.w < 1 && material.alpha == Material::Alpha::kOpaque) material.alpha = Material::Alpha::kBlend;
  const auto known = of_picture_.find(entry.picture);
  const bool shared = known != of_picture_.end();
  Image image;
  const bool read = !entry.picture.empty() && !shared && ReadImageFile(entry.picture, &image);
  entry.look.has_picture = shared || read;
  if (shared) material.base_color_image = known->second;
  else if (read) image.name = entry.picture.filename().string();
  else if (!entry.picture.empty()) lost_pictures_.push_back(entry.picture.filename().string());
  // Exporters write any colour beside a picture, black too; what is meant is the picture.
  if (entry.look.has_picture) material.base_color = {1, 1, 1, material.base_color.w};
  entry.look.material = builder->AddMaterial(material, read ? &image : nullptr);
  if (read) of_picture_[entry.picture] = builder->ImageOf(entry.look.material);
  return entry.look;
}

void ObjMaterials::Warn(const fs::path& obj, std::vector<std::string>* warnings) const {
  if (warnings == nullptr) return;
  const auto warn = [&](const std::vector<std::string>& lost, const char* what) {
    if (lost.empty()) return;
    warnings->push_back(obj.string() + ": " + std::to_string(lost.size()) + " " + what + ", such as '" + lost.front() +
                        "'; their surfaces are plain");
  };
  warn(lost_libraries_, "material libraries are not beside it");
  warn(lost_pictures_, "pictures are not beside it, or no PNG, JPEG or WebP");
}

}  // namespace flaneur
