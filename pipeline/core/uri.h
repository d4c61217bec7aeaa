// File names as glTF writes them.
#pragma once
#include <string>
#include <string_view>

namespace flaneur {

// %20 and its like as the character (RFC 3986, section 2.1); a % without two digits behind it stays.
std::string DecodedUri(std::string_view uri);

}  // namespace flaneur
