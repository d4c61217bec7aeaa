// Back to how a visit begins, for the next visitor.
#pragma once
#include "runtime/render/frame.h"
#include "runtime/simulation/simulation.h"
#include "runtime/visit/controls.h"
#include "runtime/visit/notices.h"

namespace flaneur {

// What a visitor has changed in a visit, besides the pages.
struct VisitSoFar {
  Simulation& simulation;
  Controls& controls;
  CameraInput& wishes;
  Notices& notices;
};

// The visitor is at the start, nothing is pressed or chosen, and the tour is not begun; the crowd goes on. The settings
// that come with `delivered`, language and field of view among them, have still to be heeded (Controls::applies).
void GoHome(const PlayerSettings& delivered, const VisitSoFar& visit);

// Whoever is there now sets out: the tour that waited since GoHome begins.
void BeginVisit(const VisitSoFar& visit);

}  // namespace flaneur
