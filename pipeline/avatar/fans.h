// The fans of a surface: faces around a vertex that follow each other over common edges. Where a surface has two sides
// everywhere a vertex has one fan; where more faces meet at an edge or a corner, several.
#pragma once
#include <array>
#include <vector>

#include "pipeline/avatar/wedge_surface.h"

namespace flaneur {

// The fan of each face's corners, numbered from 0. At an edge of more than two faces those go on into each other that
// are wound alike and bend least; a face never goes on into its own back.
std::vector<std::array<int, 3>> FansOf(const WedgeSurface& surface);

}  // namespace flaneur
