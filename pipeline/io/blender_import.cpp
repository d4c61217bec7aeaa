#include "pipeline/io/blender_import.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "pipeline/core/blender.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace fs = std::filesystem;

namespace {

// Where the script itself has said what is wrong with the file, that Blender ended says nothing more.
Error InTheUsersWords(const Error& e, const std::string& named, const fs::path& path) {
  const size_t at = e.message.find(named + ": "), end = e.message.rfind(" (Blender ended with status 1)");
  if (at == std::string::npos || end == std::string::npos) return e;
  const size_t said = at + named.size();
  return Fail(path.string() + e.message.substr(said, end - said));
}

}  // namespace

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
  const std::string named = fs::absolute(path).string();
  const nlohmann::json settings{{"output", gltf->string()}, {"options", {{"input", named}}}};
  BlenderOptions options;
  options.threads = 1;  // on more, some normals of a file that brings its own differ in their last bits from run to run
  const Error e = RunBlenderScript("convert/to_gltf.py", settings.dump(), options, nullptr);
  return e ? InTheUsersWords(e, named, path) : Ok();
}

}  // namespace flaneur
