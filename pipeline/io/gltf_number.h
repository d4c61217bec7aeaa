// Whole numbers of glTF extensions. Internal to pipeline/io.
#pragma once
#include <tiny_gltf.h>

namespace flaneur {

// -1 where it is no number that an int can be, and so no index of anything; fractions are cut.
inline int IndexOf(const tinygltf::Value& value) {
  const double number = value.IsNumber() ? value.GetNumberAsDouble() : -1;
  return number >= 0 && number <= 2147483647.0 ? static_cast<int>(number) : -1;
}

}  // namespace flaneur
