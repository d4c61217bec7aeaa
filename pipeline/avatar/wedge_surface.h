// The meshes of a person as one surface: corners at one place that move alike are one vertex,
// whatever their uv, normal or material. A wedge is what the corners of some faces at one vertex
// have in common besides: several wedges may meet in one vertex.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/core/mesh.h"

namespace flaneur {

struct WedgeSurface {
  struct Vertex {
    Vec3 position;
    std::array<uint16_t, 4> joints{};
    std::array<float, 4> weights{};  // sum to 1, or all 0: never skinned
  };
  struct Wedge {
    int mesh = 0;
    Vec3 normal;
    Vec2 uv, uv1;
    Vec4 color;
    int chart = -1;  // part of the mesh whose uvs go on without a seam
  };
  struct Face {
    std::array<int, 3> vertices{};
    std::array<int, 3> wedges{};
  };
  std::vector<Vertex> vertices;
  std::vector<Wedge> wedges;
  std::vector<Face> faces;
};

// Of one mesh, uv and colour: wedges at one vertex that only differ by their normal are a crease, but no seam.
bool NoSeam(const WedgeSurface::Wedge& a, const WedgeSurface::Wedge& b);

// Share `t` of b; mesh and chart are a's.
WedgeSurface::Wedge Mix(const WedgeSurface::Wedge& a, const WedgeSurface::Wedge& b, float t);

// The sum of differences of all joints' weights.
float WeightDifference(const WedgeSurface::Vertex& a, const WedgeSurface::Vertex& b);

// Gives `a` share `t` of b's weights: the four heaviest of the two together.
void MixWeights(const WedgeSurface::Vertex& b, float t, WedgeSurface::Vertex* a);

// `poses`: skinning matrices; corners must also stay together in these. Triangles without extent
// go, and so do repeated ones; any number of faces may meet at an edge.
WedgeSurface JoinWedges(const std::vector<Mesh>& meshes, const std::vector<std::vector<Mat4>>& poses = {});

// A number for each vertex of each mesh, one mesh after the other: the same where uvs go on without a seam.
std::vector<int> ChartsOf(const std::vector<Mesh>& meshes);

// Back to meshes, as many as `like`, with its names, materials and kinds of attributes.
std::vector<Mesh> SplitWedges(const WedgeSurface& surface, const std::vector<Mesh>& like);

}  // namespace flaneur
