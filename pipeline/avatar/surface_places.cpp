#include "pipeline/avatar/surface_places.h"

#include <cmath>
#include <random>

#include "pipeline/core/avatar.h"

namespace flaneur {

Triangles PosedTriangles(const std::vector<Mesh>& meshes, const std::vector<Mat4>* pose) {
  Triangles triangles;
  size_t corners = 0;
  for (const Mesh& mesh : meshes) corners += mesh.indices.size();
  triangles.reserve(corners / 3);
  std::vector<Vec3> posed;
  for (const Mesh& mesh : meshes) {
    if (pose != nullptr) posed = SkinnedPositions(mesh, *pose);
    const std::vector<Vec3>& at = pose != nullptr ? posed : mesh.positions;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      triangles.push_back({at[mesh.indices[i]], at[mesh.indices[i + 1]], at[mesh.indices[i + 2]]});
    }
  }
  return triangles;
}

Triangles BindTriangles(const WedgeSurface& surface) {
  Triangles triangles;
  triangles.reserve(surface.faces.size());
  for (const auto& face : surface.faces) {
    auto& corners = triangles.emplace_back();
    for (size_t k = 0; k < 3; ++k) {
      corners[k] = surface.vertices[static_cast<size_t>(face.vertices[k])].position;
    }
  }
  return triangles;
}

std::vector<SurfacePlace> SpreadPlaces(const Triangles& triangles, int count) {
  std::vector<double> sums;
  double total = 0;
  for (const auto& t : triangles) {
    total += static_cast<double>(Length(Cross(t[1] - t[0], t[2] - t[0])));
    sums.push_back(total);
  }
  std::mt19937 random(1);
  const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  std::vector<SurfacePlace> places;
  size_t triangle = 0;
  for (int i = 0; i < count; ++i) {
    const double at = (i + unit()) / count * total;  // one in each of equal strips
    while (triangle + 1 < sums.size() && sums[triangle] < at) ++triangle;
    const auto root = static_cast<float>(std::sqrt(unit()));
    const auto share = static_cast<float>(unit());
    places.push_back({static_cast<uint32_t>(triangle), {1 - root, root * (1 - share), root * share}});
  }
  return places;
}

}  // namespace flaneur
