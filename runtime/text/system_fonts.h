// The fonts of this machine, by fontconfig. A library of its own: programs without it have the built-in font alone.
#pragma once
#include "runtime/text/fonts.h"

namespace flaneur {

// For a Fonts. fontconfig is only woken for the first letter that the built-in font lacks.
FindFont SystemFonts();

}  // namespace flaneur
