// How large and in which colours everything that the visitor reads is drawn.
#pragma once
#include <array>
#include <string>

#include "runtime/render/frame.h"
#include "runtime/render/text_layer.h"
#include "runtime/simulation/simulation.h"
#include "runtime/visit/controls.h"

namespace flaneur {

using PageColor = std::array<uint8_t, 4>;  // red, green, blue, opacity

struct PageLook {
  std::string language;
  float letter_px = 20;  // of text that is read at arm's length or 2 m away, as the window is
  float outline_px = 0;  // round buttons and panels
  bool high_contrast = false;
  PageColor panel{18, 15, 13, 219}, text{247, 242, 230, 255}, button{61, 51, 41, 230}, marked{168, 107, 36, 255},
      marked_text{247, 242, 230, 255}, pressed{204, 138, 51, 255}, outline{250, 204, 107, 255}, veil{0, 0, 0, 110};
};

// Of the player's own words: the visitor's, else the tour's.
std::string PageLanguage(const Controls& controls, const Simulation& simulation);

// For a picture of this size.
PageLook LookOf(const Controls& controls, const Simulation& simulation, int width_px, int height_px);
// Of letters as large as the look's.
TextLook TextOf(const PageLook& look);
// The settings' eye height, or the tour's own.
float EyeHeight_m(const PlayerSettings& settings, float own_m);
// Of the tour's captions and the player's notices.
CaptionStyle CaptionStyleOf(const PlayerSettings& settings, const std::string& language);

}  // namespace flaneur
