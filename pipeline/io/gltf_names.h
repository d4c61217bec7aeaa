// How parts of a glTF file are named in messages. Internal to pipeline/io.
#pragma once
#include <string>

#include "runtime/base/text.h"

namespace flaneur {

inline std::string Quoted(const std::string& name) { return std::string("'").append(OneLine(name)) + "'"; }

// Its number among those of its kind where it has none.
inline std::string NameOr(const std::string& name, const char* kind, size_t index) {
  return name.empty() ? std::string(kind) + " " + std::to_string(index) : name;
}

}  // namespace flaneur
