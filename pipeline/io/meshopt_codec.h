// EXT_meshopt_compression: bufferViews whose bytes meshoptimizer's codecs have made smaller.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/math.h"

namespace tinygltf {
class Model;
}

namespace flaneur {

inline constexpr char kMeshoptExtension[] = "EXT_meshopt_compression";

// Decodes every compressed bufferView of the model, whose own buffer, offset and length are to be
// those of the compressed bytes (see ParseGltf), into a buffer of its own. Errors name the view.
Error DecodeMeshoptViews(tinygltf::Model* model);

// `count` elements of `stride` bytes (a multiple of 4) as the extension's mode ATTRIBUTES.
std::vector<uint8_t> EncodeMeshopt(std::span<const uint8_t> bytes, size_t stride);

// A unit quaternion as the filter QUATERNION takes it: the three lesser components in `bits` (4 to
// 16), the scale and which one is missing in the last.
std::array<int16_t, 4> FilteredRotation(Vec4 rotation, int bits);
// A number as the filter EXPONENTIAL takes it, in whole steps of 2 to the power of `exponent`.
uint32_t FilteredNumber(float value, int exponent);
// What the filters make of these, rounding and all.
Vec4 Unfiltered(const std::array<int16_t, 4>& rotation);
float Unfiltered(uint32_t number);

}  // namespace flaneur
