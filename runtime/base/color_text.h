// Colours as designers write them: "#2f4f8f".
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "runtime/base/math.h"

namespace flaneur {

// sRGB, 0 to 1. None where the text is not '#' and six hexadecimal digits.
std::optional<Vec3> ColorFromText(std::string_view text);

// Rounded to 8 bits a channel.
std::string TextFromColor(Vec3 color);

}  // namespace flaneur
