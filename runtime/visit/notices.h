// Short words to the visitor at the foot of the picture: how to walk, that the tour waits, how to come back to it, what
// is next. They go by themselves.
#pragma once
#include <string>

#include "runtime/render/frame.h"
#include "runtime/simulation/simulation.h"
#include "runtime/visit/controls.h"

namespace flaneur {

struct Notices {
  std::string text;
  float left_s = 0;                                   // that it is still shown
  bool is_hint = false;                               // how to walk
  bool gives_way = false;                             // to the tour's captions
  bool paused = false, follows = true, over = false;  // as seen last, these and the following
  size_t halt = 0;
  std::string language;
};

// How to walk, for somebody new.
void BeginHint(const Controls& controls, const Simulation& simulation, Notices* notices);

// passed_s since the last picture.
void FollowNotices(const Controls& controls, const Simulation& simulation, float passed_s, Notices* notices);

// Something else, for a while, instead of what has just changed.
void TellNotice(const std::string& text, const Controls& controls, const Simulation& simulation, Notices* notices);

// Into the picture, instead of its caption, or before it where that stays.
void ShowNotice(const Notices& notices, bool fades, bool caption_stays, FrameInput* frame);

}  // namespace flaneur
