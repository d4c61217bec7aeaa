// What stands between two wedges, or two vertices, of a surface.
#pragma once
#include "pipeline/avatar/wedge_surface.h"

namespace flaneur {

// Of one mesh, uv and colour: wedges at one vertex that only differ by their normal are a crease, but no seam.
bool NoSeam(const WedgeSurface::Wedge& a, const WedgeSurface::Wedge& b);

// Share `t` of b; mesh and chart are a's.
WedgeSurface::Wedge Mix(const WedgeSurface::Wedge& a, const WedgeSurface::Wedge& b, float t);

// The sum of differences of all joints' weights.
float WeightDifference(const WedgeSurface::Vertex& a, const WedgeSurface::Vertex& b);

// Gives `a` share `t` of b's weights: the four heaviest of the two together.
void MixWeights(const WedgeSurface::Vertex& b, float t, WedgeSurface::Vertex* a);

}  // namespace flaneur
