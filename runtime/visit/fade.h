// From black into the picture, where the view jumps and shall not startle.
#pragma once

namespace flaneur {

struct Fade {
  float left_s = 0;
};

void BeginFade(Fade* fade);
// Over everything, between an Overlay's Begin and Draw; passed_s since the last picture.
void ShowFade(int width_px, int height_px, float passed_s, Fade* fade);

}  // namespace flaneur
