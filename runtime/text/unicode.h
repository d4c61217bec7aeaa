// Text as code points, and what Unicode says of them.
#pragma once
#include <string>
#include <string_view>

namespace flaneur {

// Of UTF-8; broken bytes become U+FFFD.
std::u32string CodePoints(std::string_view text);
std::string Utf8(std::u32string_view text);

// Spaces, marks that only steer, and variation selectors need no picture.
bool IsInvisible(char32_t letter);
// Of the language's script, such as "ar" or "he-IL".
bool IsRightToLeft(std::string_view language);

}  // namespace flaneur
