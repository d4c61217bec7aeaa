// What JSON asks for, told from its text before it is parsed.
#pragma once
#include <cstdint>
#include <string_view>

namespace flaneur {

// At most so much the parsed values take: by what separates and opens them, and the text of strings.
inline uint64_t MemoryOfJson_bytes(std::string_view json) {
  constexpr uint64_t kValue_bytes = 24, kMember_bytes = 96, kBlock_bytes = 64;
  uint64_t bytes = json.size();
  bool in_string = false;
  for (size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_string && c == '\\') ++i;
    else if (c == '"') in_string = !in_string;
    else if (in_string) continue;
    else if (c == ',') bytes += 2 * kValue_bytes;  // a list that grows is there twice
    else if (c == ':') bytes += kMember_bytes;
    else if (c == '[' || c == '{') bytes += kBlock_bytes;
  }
  return bytes;
}

}  // namespace flaneur
