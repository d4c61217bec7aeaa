// The way to what a visitor has chosen on the map, and how it ends.
#pragma once
#include <bitset>

#include "runtime/simulation/simulation.h"
#include "runtime/visit/controls.h"
#include "runtime/visit/notices.h"

namespace flaneur {

struct Leading {
  bool led = false;  // to a place that is no stop
  std::bitset<kInputCodes> was_down;
};

// What it works on.
struct LeadingIn {
  Simulation& s;
  Controls& controls;
  Notices& notices;
  CameraInput& wishes;
  Leading& leading;
};

// Says so to the visitor, or that there is no way.
void LeadToStop(size_t stop, const LeadingIn& in);
void LeadToPlace(Vec2 place, const LeadingIn& in);
// Any key, and any tap, ends being led; a key that walks does so by itself.
void StopWhereAsked(const WindowInput& input, const LeadingIn& in);

}  // namespace flaneur
