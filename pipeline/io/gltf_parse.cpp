#include "pipeline/io/gltf_parse.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "pipeline/core/child_policy.h"
#include "pipeline/io/gltf_demands.h"
#include "pipeline/io/meshopt_codec.h"
#include "runtime/base/file.h"
#include "runtime/base/limits.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

using nlohmann::json;

constexpr std::string_view kDraco = "KHR_draco_mesh_compression";
constexpr std::string_view kUnknownData[] = {"data:image/ktx2;", "data:image/webp;"};
constexpr size_t kJsonOffset = 20;  // of a binary file's JSON: file header and chunk header

// Keeps the file's bytes; decoding is the affair of whoever uses the picture.
bool KeepImageBytes(tinygltf::Image* image, const int, std::string*, std::string*, int, int, const unsigned char* bytes,
                    int size, void*) {
  // An image in a bufferView is fetched later, with its bounds checked.
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  image->as_is = true;
  return true;
}

uint32_t GetU32(const std::vector<uint8_t>& bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 4; i-- > 0;) value = value << 8 | bytes[at + i];
  return value;
}

void SetU32(uint32_t value, size_t at, std::vector<uint8_t>* bytes) {
  for (size_t i = 0; i < 4; ++i) (*bytes)[at + i] = static_cast<uint8_t>(value >> (8 * i));
}

// tinygltf built without Draco refuses index accessors that have no bufferView, as glTF allows them
// beside compressed data. The Draco data has the indices, so the accessor is not needed.
void DropDracoIndices(json* root) {
  if (!root->is_object() || !root->contains("meshes") || !(*root)["meshes"].is_array()) return;
  for (json& mesh : (*root)["meshes"]) {
    if (!mesh.is_object() || !mesh.contains("primitives") || !mesh["primitives"].is_array()) {
      continue;
    }
    for (json& primitive : mesh["primitives"]) {
      if (!primitive.is_object() || !primitive.contains("extensions")) continue;
      const json& extensions = primitive["extensions"];
      if (extensions.is_object() && extensions.contains(kDraco)) primitive.erase("indices");
    }
  }
}

bool IsObjectWith(const json& item, const char* key) {
  return item.is_object() && item.contains(key) && item[key].is_object();
}

// A bufferView that EXT_meshopt_compression made smaller becomes its compressed bytes; the buffer
// that it would otherwise lie in has no bytes in the file, which tinygltf would refuse.
void FindMeshoptBytes(json* root) {
  const auto each = [&](const char* list, auto visit) {
    if (!root->is_object() || !root->contains(list) || !(*root)[list].is_array()) return;
    for (json& item : (*root)[list]) {
      if (IsObjectWith(item, "extensions") && IsObjectWith(item["extensions"], kMeshoptExtension)) {
        visit(&item, item["extensions"][kMeshoptExtension]);
      }
    }
  };
  each("bufferViews", [](json* view, const json& compressed) {
    for (const char* key : {"buffer", "byteOffset", "byteLength"}) {
      if (compressed.contains(key)) (*view)[key] = compressed[key];
    }
    if (!compressed.contains("byteOffset")) view->erase("byteOffset");
  });
  each("buffers", [](json* buffer, const json& compressed) {
    if (compressed.value("fallback", json(false)) != json(true)) return;
    *buffer = {{"byteLength", 1}, {"uri", "data:application/octet-stream;base64,AA=="}};
  });
}

// tinygltf knows but a few types of data that stand in the JSON itself.
void RenameImageData(json* root) {
  if (!root->is_object() || !root->contains("images") || !(*root)["images"].is_array()) return;
  for (json& image : (*root)["images"]) {
    if (!image.is_object() || !image.contains("uri") || !image["uri"].is_string()) continue;
    const std::string& uri = image["uri"].get_ref<const std::string&>();
    for (const std::string_view known : kUnknownData) {
      if (!uri.starts_with(known)) continue;
      image["uri"] = "data:application/octet-stream;" + uri.substr(known.size());
      break;
    }
  }
}

// The files that a model names beside itself are read as all files are: of the disk alone, and no more than there may
// be.
struct NamedFiles {
  uint64_t bytes = 0;  // of all of them, each as often as it is named
};

bool IsThere(const std::string& path, void*) {
  std::error_code ec;
  return std::filesystem::exists(path, ec);
}

std::string AsItStands(const std::string& path, void*) { return path; }

bool ReadNamedFile(std::vector<unsigned char>* out, std::string* error, const std::string& path, void* files) {
  auto* named = static_cast<NamedFiles*>(files);
  Error e = CheckWithinRoots(path);
  if (!e) e = ReadFile(path, out);
  named->bytes += out->size();
  if (!e && named->bytes > kMostFile_bytes) e = Fail(path + ": the files that the model names are larger than 4 GiB");
  if (e) *error += e.message + "\n";
  return !e;
}

// Empty where a binary is broken.
std::string_view JsonOf(bool binary, const std::vector<uint8_t>& bytes) {
  const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!binary) return all;
  if (bytes.size() < kJsonOffset || GetU32(bytes, 12) > bytes.size() - kJsonOffset) return {};
  return all.substr(kJsonOffset, GetU32(bytes, 12));
}

// Rewrites the JSON within the file for what tinygltf does not know. Broken JSON stays, for
// tinygltf to report.
void PrepareExtensions(bool binary, std::vector<uint8_t>* bytes) {
  const std::string_view text = JsonOf(binary, *bytes);
  if (text.empty()) return;
  const size_t begin = binary ? kJsonOffset : 0, end = begin + text.size();
  const bool draco = text.find(kDraco) != std::string_view::npos;
  const bool meshopt = text.find(kMeshoptExtension) != std::string_view::npos;
  const auto holds = [&](std::string_view data) { return text.find(data) != std::string_view::npos; };
  const bool unknown = std::any_of(std::begin(kUnknownData), std::end(kUnknownData), holds);
  if (!draco && !meshopt && !unknown) return;
  json root = json::parse(text, nullptr, false);
  if (root.is_discarded()) return;
  if (draco) DropDracoIndices(&root);
  if (meshopt) FindMeshoptBytes(&root);
  if (unknown) RenameImageData(&root);
  std::string changed = root.dump(-1, ' ', false, json::error_handler_t::replace);
  changed.resize((changed.size() + 3) / 4 * 4, ' ');
  const auto at = [&](size_t i) { return bytes->begin() + static_cast<std::ptrdiff_t>(i); };
  bytes->erase(at(begin), at(end));
  bytes->insert(at(begin), changed.begin(), changed.end());
  if (!binary) return;
  const size_t length = GetU32(*bytes, 8) + changed.size() - (end - begin);
  SetU32(static_cast<uint32_t>(length), 8, bytes);
  SetU32(static_cast<uint32_t>(changed.size()), 12, bytes);
}

}  // namespace

Error ParseGltf(const std::filesystem::path& path, tinygltf::Model* model) {
  std::vector<uint8_t> bytes;
  if (Error e = ReadFile(path, &bytes)) return e;
  const std::string file = path.string();
  const bool binary = bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
  std::string error, warning;
  bool ok = false;
  uint64_t read_bytes = bytes.size();
  try {
    if (NestsTooDeep(JsonOf(binary, bytes))) return Fail(file + ": its JSON " + kNestsTooDeep);
    PrepareExtensions(binary, &bytes);
    if (bytes.size() > 0xffffffffu) return Fail(file + ": larger than 4 GiB; split it");
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(KeepImageBytes, nullptr);
    NamedFiles named;
    loader.SetFsCallbacks({IsThere, AsItStands, ReadNamedFile, nullptr, &named});
    const std::string folder = path.parent_path().string();
    const unsigned size = static_cast<unsigned>(bytes.size());
    ok = binary ? loader.LoadBinaryFromMemory(model, &error, &warning, bytes.data(), size, folder)
                : loader.LoadASCIIFromString(model, &error, &warning, reinterpret_cast<const char*>(bytes.data()), size,
                                             folder);
    read_bytes += named.bytes;
  } catch (const std::exception& e) {
    error = e.what();
  }
  if (ok) {
    Error decoded = CheckDemands(*model, read_bytes);
    if (!decoded) decoded = DecodeMeshoptViews(model);
    return decoded ? Fail(file + ": " + decoded.message) : Ok();
  }
  if (error.empty()) error = "broken";
  while (!error.empty() && (error.back() == '\n' || error.back() == ' ')) error.pop_back();
  return Fail(file + (binary ? ": broken or truncated glTF binary: " : ": not a glTF file: ") + PlainJsonError(error));
}

}  // namespace flaneur
