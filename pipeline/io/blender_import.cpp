#include "pipeline/io/blender_import.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "pipeline/core/blender.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace fs = std::filesystem;

bool NeedsBlender(const fs::path& path) {
  static constexpr const char* kExtensions[] = {".blend", ".fbx", ".dae",  ".x3d",  ".wrl",
                                                ".abc",   ".usd", ".usda", ".usdc", ".usdz"};
  return std::any_of(std::begin(kExtensions), std::end(kExtensions),
                     [&](const char* extension) { return HasExtension(path, extension); });
}

Error ConvertToGltf(const fs::path& path, TemporaryFolder* folder, fs::path* gltf) {
  if (Error e = CheckReadable(path)) return e;
  if (Error e = folder->Create("flaneur_import_")) return e;
  *gltf = folder->path() / path.filename().replace_extension(".glb");
  const nlohmann::json settings{{"output", gltf->string()}, {"options", {{"input", fs::absolute(path).string()}}}};
  return RunBlenderScript("convert/to_gltf.py", settings.dump(), {}, nullptr);
}

}  // namespace flaneur
