#include "runtime/simulation/side_by_side.h"

namespace flaneur {

void StepSideBySide(const std::vector<Simulation*>& runs, const std::vector<float>& frame_ms) {
  OtherPeople others;  // where they are before any of the runs goes on
  for (size_t k = 1; k < runs.size(); ++k) {
    const Crowd& c = runs[k]->town.crowd;
    others.position.insert(others.position.end(), c.position.begin(), c.position.end());
    others.radius_m.insert(others.radius_m.end(), c.radius_m.begin(), c.radius_m.end());
  }
  for (size_t k = 0; k < runs.size(); ++k) {
    CameraInput input;
    const bool together = !runs[k]->visitor.legs.empty();
    if (together && k == 0) input.minds = &others;
    if (together && k > 0) input.as = &runs[0]->visitor;
    StepSimulation(input, frame_ms[k], runs[k]);
  }
}

}  // namespace flaneur
