// Models that only Blender reads.
#pragma once
#include <filesystem>

#include "pipeline/core/temporary_folder.h"
#include "runtime/base/error.h"

namespace flaneur {

// .blend, .fbx, .dae, .x3d, .wrl, .abc and USD; upper and lower case alike.
bool NeedsBlender(const std::filesystem::path& path);

// Has Blender open `path` (also .obj) and write it as glTF into `folder`, which is created. Custom properties become
// extras, every action of a rig a clip; hidden objects stay out. Errors: no such file, no Blender, what Blender says
// about the file, neither a mesh nor a rig in it.
Error ConvertToGltf(const std::filesystem::path& path, TemporaryFolder* folder, std::filesystem::path* gltf);

}  // namespace flaneur
