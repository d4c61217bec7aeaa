// The guided tour's end: thanks, and what next.
#pragma once
#include "runtime/pack/tour_pack.h"
#include "runtime/simulation/simulation.h"
#include "runtime/visit/controls.h"
#include "runtime/visit/menu.h"

namespace flaneur {

struct TourEnd {
  float over_s = 0;  // since the tour ended for a visitor whom it led
};

// Once a picture, passed_s after the one before; opens the page once the guide has taken leave. is_asked: a page is
// open.
void FollowTourEnd(const TourPack& pack, const Simulation& simulation, bool is_asked, float passed_s, TourEnd* end,
                   Controls* controls, CameraInput* wishes, Menu* menu);

}  // namespace flaneur
