// What a parsed glTF model asks for, before anything of it is read.
#pragma once
#include <cstdint>

#include "runtime/base/error.h"

namespace tinygltf {
class Model;
}

namespace flaneur {

// Counts what its meshes, animations, skins, images and compressed views would take, each as often as it is named, and
// how deep its nodes are in each other. Errors: more than runtime/base/limits.h allows a file of that size.
Error CheckDemands(const tinygltf::Model& model, uint64_t file_bytes);

}  // namespace flaneur
