#include "pipeline/io/blender_import.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <string>

#include "pipeline/core/subprocess.h"

namespace flaneur {
namespace fs = std::filesystem;

bool NeedsBlender(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension == ".blend" || extension == ".fbx" || extension == ".dae";
}

Error ConvertToGltf(const fs::path& path, TemporaryFolder* folder, fs::path* gltf) {
  std::error_code ec;
  if (!fs::is_regular_file(path, ec)) return Fail(path.string() + ": no such file");
  if (Error e = folder->Create("flaneur_import_")) return e;
  *gltf = folder->path() / path.filename().replace_extension(".glb");
  const nlohmann::json settings{{"output", gltf->string()}, {"options", {{"input", fs::absolute(path).string()}}}};
  return RunBlenderScript("convert/to_gltf.py", settings.dump(), {}, nullptr);
}

}  // namespace flaneur
