// A glTF file's bytes to tinygltf's model. Pictures stay as they are in the file.
#pragma once
#include <filesystem>

#include "runtime/base/error.h"

namespace tinygltf {
class Model;
}

namespace flaneur {

// Errors name the path: unreadable, neither glTF binary nor glTF text, truncated, an external
// buffer missing.
Error ParseGltf(const std::filesystem::path& path, tinygltf::Model* model);

}  // namespace flaneur
