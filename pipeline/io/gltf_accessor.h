// Numbers out of a glTF file's buffers, every offset checked. The errors say what is wrong with the
// accessor; the caller adds the file and the element.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/base/error.h"

namespace tinygltf {
class Model;
}

namespace flaneur {

Error BufferViewBytes(const tinygltf::Model& model, int view, std::span<const uint8_t>* bytes);

// `components` floats an element; integers are scaled where the accessor is normalised.
// `components` 0 takes the accessor's own number. A missing bufferView reads as zeros, sparse
// values are applied.
Error ReadFloats(const tinygltf::Model& model, int accessor, int components, std::vector<float>* values);

Error ReadIndices(const tinygltf::Model& model, int accessor, std::vector<uint32_t>* indices);

}  // namespace flaneur
