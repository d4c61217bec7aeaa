// Quadric decimation of a wedge surface with OpenMesh: half-edge collapses that keep seams, borders
// and poses.
#pragma once
#include <memory>
#include <vector>

#include "pipeline/avatar/wedge_surface.h"
#include "pipeline/core/mesh.h"

namespace flaneur {

class QuadricDecimater {
 public:
  // `poses`: the same meshes in several poses, the bind pose first; a collapse costs its error in
  // all of them.
  explicit QuadricDecimater(const std::vector<std::vector<Mesh>>& poses);
  ~QuadricDecimater();

  int Triangles() const;

  // Collapses edges, cheapest first, until at most `triangles` are left or no edge may be
  // collapsed.
  void DecimateTo(int triangles);

  // What is left, as parts of the first pose's meshes: same order, materials and attributes.
  std::vector<Mesh> Meshes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flaneur
