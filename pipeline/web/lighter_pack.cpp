#include "pipeline/web/lighter_pack.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string_view>

#include "pipeline/web/jpeg.h"
#include "runtime/base/pixels.h"
#include "runtime/pack/ktx2.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {
namespace {

using Json = nlohmann::ordered_json;
constexpr size_t kHeaderBytes = 12, kChunkHeaderBytes = 8, kAlignment = 16;  // of a KTX2 file's levels

uint32_t Word(const std::vector<uint8_t>& bytes, size_t at) {
  uint32_t word = 0;
  std::memcpy(&word, &bytes[at], sizeof word);
  return word;
}

void PutWord(uint32_t word, size_t at, std::vector<uint8_t>* bytes) { std::memcpy(&(*bytes)[at], &word, sizeof word); }

Json& PlaceOf(Json& view) {
  const auto extensions = view.find("extensions");
  const char* packed = "EXT_meshopt_compression";
  return extensions != view.end() && extensions->contains(packed) ? (*extensions)[packed] : view;
}

std::vector<uint8_t> Glb(const Json& json, const std::vector<uint8_t>& binary) {
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::vector<uint8_t> out(kHeaderBytes + 2 * kChunkHeaderBytes + text.size() + binary.size());
  size_t at = 0;
  for (uint32_t word :
       {0x46546C67u, 2u, static_cast<uint32_t>(out.size()), static_cast<uint32_t>(text.size()), 0x4E4F534Au})
    PutWord(word, at, &out), at += sizeof word;
  std::memcpy(&out[at], text.data(), text.size());
  at += text.size();
  for (uint32_t word : {static_cast<uint32_t>(binary.size()), 0x004E4942u}) PutWord(word, at, &out), at += sizeof word;
  if (!binary.empty()) std::memcpy(&out[at], binary.data(), binary.size());
  return out;
}

// Views of atlases' pictures. // How many levels of each are left out.
std::map<size_t, int> AtlasViews(const Json& json, const Lighter& lighter) {
  std::map<size_t, int> views;
  for (const Json& avatar : json["extensions"][kTourExtension]["avatars"]) {
    for (const char* key : {"albedo_view", "normal_view", "depth_view", "motion_view", "tints_view"}) {
      if (avatar["impostor"].contains(key))
        views[avatar["impostor"][key].get<size_t>()] =
            std::string_view(key) == "normal_view" ? lighter.normal_levels_left_out : lighter.atlas_levels_left_out;
    }
  }
  return views;
}

Error LeaveOut(int levels, const std::string& view, std::span<const uint8_t> before, std::vector<uint8_t>* after) {
  PackTexture texture;
  if (Error e = ReadKtx2(before, &texture)) return Fail("buffer view " + view + " " + e.message);
  for (int k = 0; k < levels && texture.levels.size() > 1; ++k) {
    texture.levels.erase(texture.levels.begin());
    texture.width_px = std::max(1, texture.width_px / 2);
    texture.height_px = std::max(1, texture.height_px / 2);
  }
  *after = WriteKtx2(texture, Supercompression::kNone);  // a site's files are compressed as they are sent
  return Ok();
}

std::set<size_t> JpegViews(const Json& json) {
  std::set<size_t> views;
  for (const Json& image : json.value("images", Json::array())) {
    if (image.value("mimeType", "") == "image/jpeg") views.insert(image["bufferView"].get<size_t>());
  }
  return views;
}

// Out of the description; the views that it alone used.
std::set<size_t> TakeTitlePage(Json* json) {
  std::set<size_t> views;
  Json& tour = (*json)["extensions"][kTourExtension];
  const Json page = tour.value("title_page", Json::object());
  for (const auto& [key, value] : page.items()) {
    if (key.ends_with("_view")) views.insert(value.get<size_t>());
  }
  tour.erase("title_page");
  return views;
}

// The index that stands for each accessor from now on: the page asks none for its bounds, and those that say the same
// are one. What is packed with Draco has many of them, which are read before anything is seen.
std::vector<size_t> MergeAccessors(Json* json) {
  std::vector<size_t> now;
  std::map<std::string, size_t> known;
  Json kept = Json::array();
  for (Json& accessor : (*json)["accessors"]) {
    accessor.erase("min");
    accessor.erase("max");
    const auto [place, is_new] = known.try_emplace(accessor.dump(), kept.size());
    now.push_back(place->second);
    if (is_new) kept.push_back(std::move(accessor));
  }
  (*json)["accessors"] = std::move(kept);
  return now;
}

void UseFewerAccessors(Json* json) {
  if (!json->contains("accessors")) return;
  const std::vector<size_t> now = MergeAccessors(json);
  const auto change = [&](Json& owner, const char* key) {
    if (owner.contains(key)) owner[key] = now[owner[key].get<size_t>()];
  };
  const auto change_all = [&](Json& owner) {
    for (auto& [name, accessor] : owner.items()) accessor = now[accessor.get<size_t>()];
  };
  const auto visit = [&](const char* list, const char* inner, auto each) {
    for (Json& owner : (*json)[list]) {
      for (Json& item : owner[inner]) each(item);
    }
  };
  if (json->contains("meshes"))
    visit("meshes", "primitives", [&](Json& primitive) {
      change(primitive, "indices");
      change_all(primitive["attributes"]);
      if (primitive.contains("targets"))
        for (Json& target : primitive["targets"]) change_all(target);
    });
  if (json->contains("animations"))
    visit("animations", "samplers", [&](Json& sampler) {
      change(sampler, "input");
      change(sampler, "output");
    });
  if (json->contains("skins"))
    for (Json& skin : (*json)["skins"]) change(skin, "inverseBindMatrices");
}

// As it is where that is smaller.
void Recode(int quality, std::vector<uint8_t>* picture) {
  const auto pixels = Decoded(*picture);
  if (!pixels) return;
  std::vector<uint8_t> smaller = EncodeJpeg(*pixels, quality);
  if (!smaller.empty() && smaller.size() < picture->size()) *picture = std::move(smaller);
}

}  // namespace

Error MakeLighter(const Lighter& lighter, std::vector<uint8_t>* pack) {
  const size_t text = Word(*pack, kHeaderBytes), text_at = kHeaderBytes + kChunkHeaderBytes;
  Json json = Json::parse(pack->begin() + static_cast<std::ptrdiff_t>(text_at),
                          pack->begin() + static_cast<std::ptrdiff_t>(text_at + text));
  const std::span<const uint8_t> old = std::span(*pack).subspan(text_at + text + kChunkHeaderBytes);
  const std::map<size_t, int> atlases = AtlasViews(json, lighter);
  const std::set<size_t> jpegs = JpegViews(json), dropped = TakeTitlePage(&json);
  std::vector<uint8_t> binary;
  std::map<std::pair<size_t, size_t>, size_t> moved;  // what several views share stays shared
  for (size_t k = 0; k < json["bufferViews"].size(); ++k) {
    Json& place = PlaceOf(json["bufferViews"][k]);
    const size_t offset = place.value("byteOffset", size_t{0}), length = place["byteLength"];
    const auto known = moved.find({offset, length});
    if (known != moved.end()) {
      place["byteOffset"] = known->second;
      continue;
    }
    binary.resize((binary.size() + kAlignment - 1) / kAlignment * kAlignment);
    place["byteOffset"] = moved[{offset, length}] = binary.size();
    const std::span<const uint8_t> content = old.subspan(offset, length);
    std::vector<uint8_t> written(content.begin(), content.end());
    if (const auto atlas = atlases.find(k); atlas != atlases.end()) {
      if (Error e = LeaveOut(atlas->second, std::to_string(k), content, &written)) return e;
    } else if (jpegs.contains(k) && lighter.picture_quality > 0) {
      Recode(lighter.picture_quality, &written);
    } else if (dropped.contains(k)) {
      written.resize(1);  // a buffer view cannot be empty
    }
    place["byteLength"] = written.size();
    binary.insert(binary.end(), written.begin(), written.end());
  }
  binary.resize((binary.size() + 3) / 4 * 4);
  json["buffers"][0]["byteLength"] = binary.size();
  UseFewerAccessors(&json);
  *pack = Glb(json, binary);
  return Ok();
}

}  // namespace flaneur
