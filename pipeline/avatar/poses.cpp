#include "pipeline/avatar/poses.h"

namespace flaneur {

std::vector<std::vector<Mat4>> WalkPoses(const Avatar& avatar, int count) {
  std::vector<std::vector<Mat4>> poses;
  const Clip* walk = FindClip(avatar, "walk");
  for (int i = 0; walk != nullptr && i < count; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(count);
    poses.push_back(SkinningMatrices(avatar, *walk, share * walk->duration_s));
  }
  return poses;
}

std::vector<Mesh> Shapes(const std::vector<Mesh>& meshes) {
  std::vector<Mesh> shapes;
  for (const Mesh& mesh : meshes) {
    Mesh& shape = shapes.emplace_back();
    shape.positions = mesh.positions;
    shape.joints = mesh.joints;
    shape.weights = mesh.weights;
    shape.indices = mesh.indices;
  }
  return shapes;
}

std::vector<Mesh> Posed(const std::vector<Mesh>& meshes, const std::vector<Mat4>& matrices) {
  std::vector<Mesh> posed;
  for (const Mesh& mesh : meshes) posed.push_back(Skinned(mesh, matrices));
  return posed;
}

}  // namespace flaneur
