// The title page as a picture of the window's size.
#pragma once
#include "runtime/base/pixels.h"
#include "runtime/tour_data/title_page.h"

namespace flaneur {

// The page's files, decoded; what is damaged or larger than a pack may hold is left out.
struct TitlePictures {
  Pixels picture, logo;  // no rgba: none
  Vec3 background;
};
TitlePictures DecodeTitlePage(const TitlePage& page);

// Opaque. The picture fills it, cut at the sides that are too long; the logo stands in the middle of the upper two
// thirds, at most half as wide and high as the page.
Pixels LayOutTitlePage(const TitlePictures& pictures, int width_px, int height_px);

// Where the bar is: a share of the page's width and height from its upper left corner.
struct TitleBar {
  float left = 0.25f, right = 0.75f, top = 0.88f, bottom = 0.892f;
};

}  // namespace flaneur
