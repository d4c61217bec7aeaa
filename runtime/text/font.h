// The font inside the program: DejaVu Sans, with Latin, Greek, Cyrillic, Armenian, Georgian, Hebrew and Arabic letters.
// Internal to runtime/text.
#pragma once
#include <span>

namespace flaneur {

// The TrueType file. It stays where it is as long as the program runs.
std::span<const unsigned char> BuiltInFont();

}  // namespace flaneur
