// The materials of a glTF file and the pictures that they use. Internal to pipeline/io.
#pragma once
#include <string>
#include <vector>

#include "pipeline/io/gltf_document.h"
#include "pipeline/io/gltf_primitive.h"

namespace tinygltf {
class Model;
}

namespace flaneur {

// `uv_sources`: where each material's pictures lie on meshes.
Error ReadMaterials(const tinygltf::Model& model, GltfDocument* document, std::vector<UvSource>* uv_sources,
                    std::vector<std::string>* warnings);

}  // namespace flaneur
