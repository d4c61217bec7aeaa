// Buffer views of animations that EXT_meshopt_compression made smaller: its mode ATTRIBUTES with the filters NONE,
// QUATERNION and EXPONENTIAL, after the extension's specification (appendices A and B). Internal to runtime/pack.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace flaneur {

// `count` elements of `stride` bytes each. Throws PackRefused where the bytes or numbers are broken.
std::vector<uint8_t> DecodeMeshoptView(std::span<const uint8_t> bytes, size_t count, size_t stride,
                                       const std::string& filter);

}  // namespace flaneur
