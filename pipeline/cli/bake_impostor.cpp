#include "pipeline/cli/bake_impostor.h"

#include <nlohmann/json.hpp>

#include "runtime/base/file.h"

namespace flaneur {
namespace {

using Json = nlohmann::json;

bool ReadPng(const std::filesystem::path& path, Image* image) {
  image->name = path.stem().string();
  image->mime_type = "image/png";
  return !ReadFile(path, &image->bytes);
}

void FromJson(const Json& json, ImpostorAtlas* atlas) {
  atlas->directions = json.at("directions");
  atlas->elevations_deg = json.at("elevations_deg").get<std::vector<float>>();
  atlas->frames = json.at("frames");
  atlas->cell_width_px = json.at("cell_width_px");
  atlas->cell_height_px = json.at("cell_height_px");
  atlas->window_width_m = json.at("window_width_m");
  atlas->window_height_m = json.at("window_height_m");
  atlas->bottom_m = json.at("bottom_m");
  atlas->depth_range_m = json.at("depth_range_m");
  for (const Json& clip : json.at("clips")) {
    atlas->clips.push_back({clip.at("name"), clip.at("first_frame"), clip.at("phases")});
  }
}

}  // namespace

bool ReadCachedImpostor(const std::filesystem::path& folder, const std::string& fingerprint, ImpostorAtlas* atlas) {
  std::string text, known;
  if (ReadTextFile(folder / "fingerprint", &known) || known != fingerprint ||
      ReadTextFile(folder / "impostor.json", &text)) {
    return false;
  }
  try {
    ImpostorAtlas read;
    FromJson(Json::parse(text), &read);
    if (!ReadPng(folder / "albedo.png", &read.albedo) || !ReadPng(folder / "normal.png", &read.normal)) return false;
    *atlas = std::move(read);
    return true;
  } catch (const Json::exception&) {
    return false;  // a cache that cannot be read is no cache
  }
}

Error WriteCachedImpostor(const std::filesystem::path& folder, const std::string& fingerprint,
                          const ImpostorAtlas& atlas) {
  std::error_code ec;
  std::filesystem::remove(folder / "fingerprint", ec);
  if (Error e = WriteImpostor(folder, atlas)) return e;
  return WriteTextFile(folder / "fingerprint", fingerprint);
}

}  // namespace flaneur
