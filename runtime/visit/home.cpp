#include "runtime/visit/home.h"

#include "runtime/walk/start.h"

namespace flaneur {

void GoHome(const PlayerSettings& delivered, const VisitSoFar& visit) {
  GoToStart(InTown(&visit.simulation));
  const KeyLayout layout = visit.controls.layout;
  visit.controls = MakeControls(delivered, layout, visit.simulation);
  visit.controls.applies = true;
  visit.wishes = {};
  visit.notices = {};
}

void BeginVisit(const VisitSoFar& visit) {
  bool& begun = visit.simulation.visitor.tour.begun;
  if (begun) return;
  begun = true;
  BeginHint(visit.controls, visit.simulation, &visit.notices);
}

}  // namespace flaneur
