// Closes small holes in the shell of a building.
#pragma once
#include <vector>

#include "pipeline/footprint/town_objects.h"

namespace flaneur {

struct MissingFromShell {
  std::vector<Triangle3> triangles;
  int of_faces = 0;  // of them go on, within three edges, in the plane of one beside them: surely lost
};

// Where triangles are missing from a shell, edges are left that belong to one triangle only. Returns triangles for the
// holes that three such edges bound, and, of a shell that is otherwise closed, for plane holes of a few edges more. A
// whole upright wall of four corners, if nothing else is missing, may be meant and stays open. Triangles that are
// thinner than 2 cm are left out. Vertices count as the same as Weld has it; repeated and turned triangles do not
// matter.
MissingFromShell MissingTriangles(const std::vector<Triangle3>& shell);

}  // namespace flaneur
