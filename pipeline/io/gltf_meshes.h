// The meshes of a glTF file. Internal to pipeline/io.
#pragma once
#include <vector>

#include "pipeline/io/gltf_document.h"
#include "pipeline/io/gltf_primitive.h"

namespace tinygltf {
class Model;
}

namespace flaneur {

// `uv_sources`: by material.
Error ReadMeshes(const tinygltf::Model& model, const std::vector<UvSource>& uv_sources, GltfDocument* document);

}  // namespace flaneur
