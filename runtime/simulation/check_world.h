// Whether ground and obstacles can be walked on at all, before anything is made of them. Internal to
// runtime/simulation.
#pragma once
#include "runtime/base/error.h"
#include "runtime/crowd/walkable.h"

namespace flaneur {

// Of a walkable that has its ground, circles and polygons, for people up to this radius. Errors: obstacles that lie
// over the ground, or along it, far more often than any town's do: to mark them would take minutes.
Error CheckWorld(const Walkable& walkable, float most_radius_m);

}  // namespace flaneur
