// Closes holes in the shell that houses have together. Internal to the extraction.
#pragma once
#include <vector>

#include "pipeline/footprint/town_objects.h"

namespace flaneur {

struct MissingTriangle {
  Triangle3 triangle;
  size_t member = 0;           // whose it is, of the houses asked for
  bool of_foundation = false;  // it goes on where that one's foundation ends
  bool is_of_face = false;     // three edges bound it, and it goes on in the plane of one beside it
};

// Houses that share walls are open each, and closed together. Returns triangles for the holes of up to eight edges in
// what they make together, shortest first: such as are plane, or become so once corners that go on in the planes beside
// them are cut off; of parts of faces only such as go on in a plane. A whole level face must have something of the
// house over or under it. Each triangle goes to the house that lies over or under it, else to the one in whose plane it
// goes on.
enum class Holes { kAll, kPartsOfFaces };
std::vector<MissingTriangle> MissingTogether(const std::vector<const TownObject*>& houses, Holes holes = Holes::kAll);

}  // namespace flaneur
