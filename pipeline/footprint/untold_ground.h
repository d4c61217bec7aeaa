// Ground that a town's file holds without saying so: a hill called "Plane", or the streets of a scan in one mesh.
#pragma once
#include <vector>

#include "pipeline/footprint/town_objects.h"

namespace flaneur {

// Where a town has no ground to speak of, or none but flat things, what `untagged` of its obstacles have of it becomes
// ground: the lowest faces that show upwards, in pieces over which one could walk on, that lie open to the sky for the
// most part, and from which more walls rise than hang below them (of a roof it is the other way round). Beside flat
// things, only objects that are sheets, without walls to speak of, are looked at. What is left of an object stays an
// obstacle. Faces that show downwards count where no others do, for files whose faces show any way.
void TakeUntoldGround(const std::vector<size_t>& untagged, TownObjects* town);

}  // namespace flaneur
