// What holds of a file's glTF before anything of it is read. Internal to runtime/pack.
#pragma once
#include "runtime/pack/gltf_file.h"

namespace flaneur {

// Every index, offset, count and size is a whole number from 0, or -1 where there is none; every other number is finite
// and no larger than kMostNumber. What extensions say of the tour and what is in "extras" is left to others. Throws
// PackRefused.
inline constexpr double kMostNumber = 1e30;
void CheckGltf(const Json& root);

// Throws PackRefused: two parents, a loop, too deep.
NodeTree TreeOf(const Json& root);

}  // namespace flaneur
