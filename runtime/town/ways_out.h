// Nobody is squeezed: who is cut off by the visitor and one too many goes indoors. Internal to runtime/town.
#pragma once
#include "runtime/town/town.h"

namespace flaneur {

// As many of the town's own people as would exceed the limit of high-resolution people walk to doors and exits that
// they reach without passing the visitor (paper, Fig. 13; its authors had no way out). Only with full adaptation; looks
// twice a second.
void SendEnclosedOut(const Viewer& viewer, Town* town);

// True where p is cut off, or close to the visitor while there are nearly too many: newcomers and new destinations keep
// away.
bool IsFullNear(const Viewer& viewer, const Town& town, Vec2 p);

}  // namespace flaneur
