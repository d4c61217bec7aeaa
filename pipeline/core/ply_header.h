// The header of a PLY file: what follows it, in which order and as what.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/error.h"

namespace flaneur {

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };
enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat;
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  // of a list
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;  // as the header says; the file may hold fewer
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  std::vector<std::string> pictures;  // that comments name ("TextureFile town.jpg"), as they are written
  size_t size_bytes = 0;              // what follows begins here
};

// Whether a file that begins so is a PLY.
bool IsPly(std::string_view beginning);

// Errors name the line.
Error ReadPlyHeader(std::string_view bytes, PlyHeader* header);

}  // namespace flaneur
