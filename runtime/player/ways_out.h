// Nobody is squeezed: who is cut off by the visitor and one too many goes indoors. Internal to runtime/player.
#pragma once
#include "runtime/player/simulation.h"

namespace flaneur {

// As many of the town's own people as would exceed the limit of high-resolution people walk to doors and exits that they reach
// without passing the visitor (paper, Fig. 13; its authors had no way out). Only with full adaptation; looks twice a second.
void SendEnclosedOut(Simulation* simulation);

// True where p is cut off, or close to the visitor while there are nearly too many: newcomers and new destinations keep away.
bool IsFullNear(const Simulation& simulation, Vec2 p);

}  // namespace flaneur
