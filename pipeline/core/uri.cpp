#include "pipeline/core/uri.h"

#include <charconv>

namespace flaneur {

std::string DecodedUri(std::string_view uri) {
  std::string out;
  for (size_t i = 0; i < uri.size(); ++i) {
    const std::string_view digits = uri[i] == '%' ? uri.substr(i + 1, 2) : "";
    unsigned char code = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
    const bool decoded = digits.size() == 2 && error == std::errc() && end == digits.data() + 2;
    out += decoded ? static_cast<char>(code) : uri[i];
    if (decoded) i += 2;
  }
  return out;
}

}  // namespace flaneur
