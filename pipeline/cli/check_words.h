// What a tour says, seen with the eyes of who will read it.
#pragma once
#include <string>
#include <vector>

#include "runtime/text/fonts.h"
#include "runtime/tour_data/tour_data.h"

namespace flaneur {

// A line for each language with letters that no font shows, or only one of this machine that the player does not bring
// along; and for each stop with a sound but no caption in that language, for who cannot hear it.
std::vector<std::string> WarningsOfWords(const TourData& tour, Fonts* fonts);

}  // namespace flaneur
