// The font inside the program: DejaVu Sans, with Latin, Greek and Cyrillic letters. Internal to runtime/render.
#pragma once
#include <span>

namespace flaneur {

// The TrueType file. It stays where it is as long as the program runs.
std::span<const unsigned char> FontFile();

}  // namespace flaneur
