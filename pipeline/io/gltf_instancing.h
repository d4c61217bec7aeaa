// glTF's EXT_mesh_gpu_instancing: one node's mesh in many places, as exporters write trees and lamps.
#pragma once
#include <cstdint>

#include "pipeline/io/gltf_document.h"
#include "runtime/base/error.h"

namespace tinygltf {
class Model;
class Node;
}  // namespace tinygltf

namespace flaneur {

// Of the node's mesh; 1 where it has no such extension.
uint64_t CountInstances(const tinygltf::Model& model, const tinygltf::Node& node);

// Gives each instance a node of its own, below the one that names it and called the same; that shows nothing any more.
// Before the nodes are put in order. Errors: accessors that are broken or of different counts; they name the node.
Error SpreadInstances(const tinygltf::Model& model, GltfDocument* document);

}  // namespace flaneur
