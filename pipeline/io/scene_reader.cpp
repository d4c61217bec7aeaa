#include "pipeline/io/scene_reader.h"

#include <cstdio>
#include <memory>

#include "pipeline/io/blender_import.h"
#include "pipeline/io/gltf.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

// Enough of the beginning to tell the format.
std::string Beginning(const std::filesystem::path& path) {
  std::string text(64 * 1024, '\0');
  const std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  text.resize(file ? std::fread(text.data(), 1, text.size(), file.get()) : 0);
  if (text.rfind("\xEF\xBB\xBF", 0) == 0) text.erase(0, 3);
  return text;
}

bool IsXml(const std::string& text, char first) {
  const bool utf16 = text.rfind("\xFF\xFE", 0) == 0 || text.rfind("\xFE\xFF", 0) == 0;
  return first == '<' || utf16;
}

}  // namespace

Error ReadScene(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings,
                const ReadSceneOptions& options, SceneSource* source) {
  if (Error e = CheckReadable(path)) return e;
  SceneSource unasked;
  if (!source) source = &unasked;
  *source = {};
  if (NeedsBlender(path)) {
    TemporaryFolder folder;
    std::filesystem::path gltf;
    if (Error e = ConvertToGltf(path, &folder, &gltf)) return e;
    return ReadGltfScene(gltf, scene, warnings);
  }
  const std::string text = Beginning(path);
  const size_t start = text.find_first_not_of(" \t\r\n");
  const char first = start == std::string::npos ? '\0' : text[start];
  if (IsXml(text, first)) return ReadCityGml(path, scene, warnings, options, source);
  // Members of a JSON object stand in any order: glTF must have "asset" and "version", CityJSON its "type".
  const bool city = text.find("\"CityJSON\"") != std::string::npos || text.find("\"CityObjects\"") != std::string::npos;
  if (first == '{' && city) return ReadCityJson(path, scene, warnings, options, source);
  if (HasExtension(path, ".obj")) return ReadObj(path, scene, warnings, options.obj_up);
  if (first == '{' && path.extension() != ".gltf" && path.extension() != ".glb")
    return ReadCityJson(path, scene, warnings, options, source);
  return ReadGltfScene(path, scene, warnings);
}

}  // namespace flaneur
