// Triangles the other way round.
#pragma once
#include <utility>

#include "pipeline/core/mesh.h"

namespace flaneur {

// What was seen from outside is seen from inside.
inline void TurnRound(Mesh* mesh) {
  for (size_t i = 0; i + 2 < mesh->indices.size(); i += 3) std::swap(mesh->indices[i], mesh->indices[i + 1]);
}

}  // namespace flaneur
