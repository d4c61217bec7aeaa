#include "pipeline/io/scene_reader.h"

#include <cstdio>
#include <memory>

#include "pipeline/core/ply_header.h"
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

bool IsCityJson(const std::string& text, char first) {
  return first == '{' &&
         (text.find("\"CityJSON\"") != std::string::npos || text.find("\"CityObjects\"") != std::string::npos);
}

// The glTF that `path` is, or that was made of it; a format that knows which way is up.
Error ReadUpright(const std::filesystem::path& gltf, const std::filesystem::path& path, UpAxis up, Scene* scene,
                  std::vector<std::string>* warnings) {
  if (Error e = ReadGltfScene(gltf, scene, warnings, path)) return e;
  UpAxis thin = UpAxis::kJudged;
  if (up != UpAxis::kJudged) {
    StandUp(up, scene);
  } else if (warnings && LiesOnItsSide(*scene, &thin)) {
    const std::string axis = thin == UpAxis::kX ? "x" : "z";
    warnings->push_back(path.string() + ": lies on its side, as it seems; the option 'up' (" + axis + " or -" + axis +
                        ") turns it upright");
  }
  return Ok();
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
    return ReadUpright(gltf, path, options.up, scene, warnings);
  }
  const std::string text = Beginning(path);
  const size_t start = text.find_first_not_of(" \t\r\n");
  const char first = start == std::string::npos ? '\0' : text[start];
  const bool named_gltf = HasExtension(path, ".gltf") || HasExtension(path, ".glb");
  const bool xml = IsXml(text, first);
  // Members of a JSON object stand in any order: glTF must have "asset" and "version", CityJSON its "type".
  if (xml || IsCityJson(text, first) || (first == '{' && !named_gltf && !HasExtension(path, ".obj"))) {
    if (options.up != UpAxis::kJudged)
      return Fail(path.string() + ": a city model's up is known; leave the option 'up' away");
    return xml ? ReadCityGml(path, scene, warnings, options, source)
               : ReadCityJson(path, scene, warnings, options, source);
  }
  if (HasExtension(path, ".obj")) return ReadObj(path, scene, warnings, options.up);
  if (HasExtension(path, ".ply") || IsPly(text)) return ReadPly(path, scene, warnings, options.up);
  if (HasExtension(path, ".stl")) return ReadStl(path, scene, warnings, options.up);
  if (!named_gltf && text.rfind("glTF", 0) != 0)
    return Fail(path.string() +
                ": no town that is known by its name or content; save it as glTF (.glb), OBJ, PLY, FBX or .blend");
  return ReadUpright(path, path, options.up, scene, warnings);
}

}  // namespace flaneur
