// Text in HTML.
#pragma once
#include <string>
#include <string_view>

namespace flaneur {

// For text between tags and within quoted attributes.
std::string Escaped(std::string_view text);

}  // namespace flaneur
