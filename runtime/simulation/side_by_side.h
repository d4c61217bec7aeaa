// Runs of one scenario that are shown beside each other, so that what differs between them can be seen.
#pragma once
#include <vector>

#include "runtime/simulation/simulation.h"

namespace flaneur {

// One step of each. Where the scenario says how the visitor goes, all visitors go the same way at the same moments:
// whoever holds one of them up holds them all up. Else each follows its own guided tour. frame_ms: of each, as
// StepSimulation has it.
void StepSideBySide(const std::vector<Simulation*>& runs, const std::vector<float>& frame_ms);

}  // namespace flaneur
