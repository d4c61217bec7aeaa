// What makes the guide stand out from the townspeople: a banner on a pole in the right hand, over everybody's heads; at
// the back of a figure whose skeleton shows no arm. Internal to runtime/show.
#pragma once
#include "runtime/pack/tour_pack.h"

namespace flaneur {

// The figure's mesh, of those of whom the guide is like: one of the levels, and the finest, at whose back the pole may
// be.
PackMesh GuideMesh(PackMesh level, const PackMesh& finest, const PackAvatar& figure);

// One more avatar, of the guide's name and last in the pack: with the banner, and in nobody's share. Its triangles
// count it. A pack without a guide stays as it is.
void AddGuideFigure(TourPack* pack);

}  // namespace flaneur
