#include "pipeline/io/blender_import.h"

#include <nlohmann/json.hpp>
#include <string>

#include "pipeline/core/blender.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace fs = std::filesystem;

bool NeedsBlender(const fs::path& path) {
  return HasExtension(path, ".blend") || HasExtension(path, ".fbx") || HasExtension(path, ".dae");
}

Error ConvertToGltf(const fs::path& path, TemporaryFolder* folder, fs::path* gltf) {
  if (Error e = CheckReadable(path)) return e;
  if (Error e = folder->Create("flaneur_import_")) return e;
  *gltf = folder->path() / path.filename().replace_extension(".glb");
  const nlohmann::json settings{{"output", gltf->string()}, {"options", {{"input", fs::absolute(path).string()}}}};
  return RunBlenderScript("convert/to_gltf.py", settings.dump(), {}, nullptr);
}

}  // namespace flaneur
