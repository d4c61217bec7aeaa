// The meshes of a person as one surface: corners at one place are joined, whatever their uv, normal
// or material. A wedge is a vertex of the input meshes; several wedges may meet in one vertex of
// the surface.
#pragma once
#include <array>
#include <vector>

#include "pipeline/core/mesh.h"

namespace flaneur {

struct WedgeSurface {
  struct Wedge {
    int mesh = 0;
    uint32_t vertex = 0;  // gives normal, uv and colour
    uint32_t place =
        0;  // gives position and weights; the same vertex until a corner leaves its seam
  };
  struct Face {
    std::array<int, 3> vertices{};
    std::array<int, 3> wedges{};
  };
  std::vector<Wedge> wedges;
  std::vector<Face> faces;
  std::vector<int> wedge_of_vertex;  // one of the wedges that meet there
};

// Joins corners whose positions are equal, but nowhere more than two faces at an edge, turned
// alike, nor two fans at a vertex: those parts stay apart on vertices of their own, so that none is
// lost. Triangles without extent go.
WedgeSurface JoinWedges(const std::vector<Mesh>& meshes);

}  // namespace flaneur
