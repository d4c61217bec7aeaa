#include "pipeline/io/gltf_number.h"

#include <tiny_gltf.h>

namespace flaneur {

int IndexOf(const tinygltf::Value& value) {
  const double number = value.IsNumber() ? value.GetNumberAsDouble() : -1;
  return number >= 0 && number <= 2147483647.0 ? static_cast<int>(number) : -1;
}

}  // namespace flaneur
