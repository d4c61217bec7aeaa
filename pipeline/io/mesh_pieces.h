// A large mesh cut into several, so that a reader need not decode it at one go.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/core/mesh.h"

namespace flaneur {

// The triangles' indices in groups of at most `most_triangles` (at least 1; 0: one group), whose middles lie near each
// other: cut in halves across the longer extent until they are small enough. Every triangle is in one group; within a
// group they keep their order. Every index must be below the vertex count.
std::vector<std::vector<uint32_t>> InPieces(const Mesh& mesh, size_t most_triangles);

}  // namespace flaneur
