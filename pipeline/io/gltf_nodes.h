// The nodes of a glTF file, in an order in which parents stand first, with what the town convention tags them with.
// Internal to pipeline/io.
#pragma once
#include "pipeline/io/gltf_document.h"

namespace tinygltf {
class Model;
}

namespace flaneur {

// Whether all its numbers are.
bool Finite(const Mat4& matrix);

Error ReadNodes(const tinygltf::Model& model, GltfDocument* document);

}  // namespace flaneur
