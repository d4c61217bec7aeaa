// Over the town that shows itself: its name, that a touch begins, and the languages to begin in.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "runtime/visit/page_look.h"

namespace flaneur {

// Between an Overlay's Begin and Draw. time_s: since it began to show itself.
void ShowAttractPage(const std::string& title, const std::vector<std::string>& languages, float time_s, bool moves,
                     const PageLook& look, int width_px, int height_px, TextLayer* text);

// Which of the languages is at this place of the picture, 0 to 1 from its upper left corner.
std::optional<size_t> LanguageAt(Vec2 place, size_t languages, const PageLook& look, int width_px, int height_px);

}  // namespace flaneur
