// Which of a mesh's morph targets close its eyes and open its mouth.
#pragma once
#include <array>
#include <vector>

#include "pipeline/rig/face_names.h"

namespace tinygltf {
class Model;
}

namespace flaneur {

struct WeightedTarget {
  size_t target = 0;  // of the mesh
  float weight = 1;
};

// By FaceMove; for each what VRM says of this mesh, else what the targets' names say. A movement of both eyes may be
// two targets.
using FaceTargets = std::array<std::vector<WeightedTarget>, kFaceMoves>;
FaceTargets FindFaceTargets(const tinygltf::Model& model, size_t mesh);

}  // namespace flaneur
