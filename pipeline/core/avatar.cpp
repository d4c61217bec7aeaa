#include "pipeline/core/avatar.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/array.h"

namespace flaneur {
namespace {

Vec3 Mix(Vec3 a, Vec3 b, float t) { return a * (1 - t) + b * t; }

Transform Mix(const Transform& a, const Transform& b, float t) {
  return {Mix(a.translation, b.translation, t), Slerp(a.rotation, b.rotation, t), Mix(a.scale, b.scale, t)};
}

// Key and share of the next one at the time, wrapped into the clip.
void FindKey(const Clip& clip, float time_s, int* key, float* share) {
  *key = 0;
  *share = 0;
  if (clip.keys < 2 || !(clip.duration_s > 0)) return;
  const float turns = time_s / clip.duration_s;
  const float at = (turns - std::floor(turns)) * static_cast<float>(clip.keys - 1);
  *key = std::min(static_cast<int>(at), clip.keys - 2);
  *share = at - static_cast<float>(*key);
}

Mat4 Blend(const std::array<uint16_t, 4>& joints, const std::array<float, 4>& weights,
           const std::vector<Mat4>& matrices) {
  Mat4 out;
  for (auto& column : out.m) column = {};
  for (size_t i = 0; i < 4; ++i) {
    if (weights[i] == 0) continue;
    const Mat4& matrix = matrices[joints[i]];
    for (size_t c = 0; c < 4; ++c) {
      for (size_t r = 0; r < 4; ++r) out.m[c][r] += weights[i] * matrix.m[c][r];
    }
  }
  return out;
}

// Cofactors of the upper 3x3: the inverse transpose but for length, which also holds for singular
// matrices.
Vec3 TransformNormal(const Mat4& m, Vec3 n) {
  const Vec3 x{m.m[0][0], m.m[0][1], m.m[0][2]};
  const Vec3 y{m.m[1][0], m.m[1][1], m.m[1][2]};
  const Vec3 z{m.m[2][0], m.m[2][1], m.m[2][2]};
  return Normalized(Cross(y, z) * n.x + Cross(z, x) * n.y + Cross(x, y) * n.z);
}

}  // namespace

bool IsBelow(const std::vector<Joint>& joints, int joint, int above) {
  for (int a = joint; a >= 0; a = At(joints, a).parent) {
    if (a == above) return true;
  }
  return false;
}

float WeightOn(const std::vector<bool>& joints, const Mesh& mesh, size_t vertex) {
  float weight = 0;
  for (size_t i = 0; i < 4; ++i) weight += At(joints, mesh.joints[vertex][i]) ? mesh.weights[vertex][i] : 0;
  return weight;
}

std::vector<Mesh*> AllMeshes(Avatar* avatar) {
  std::vector<Mesh*> meshes;
  for (Mesh& mesh : avatar->meshes) meshes.push_back(&mesh);
  for (AvatarProp& prop : avatar->props) {
    for (Mesh& mesh : prop.meshes) meshes.push_back(&mesh);
  }
  return meshes;
}

std::vector<Mat4> SkinningMatrices(std::span<const Joint> joints, std::span<const Transform> transforms) {
  std::vector<Mat4> matrices(joints.size());
  for (size_t j = 0; j < joints.size(); ++j) {
    const Transform& local = transforms[j];
    const Mat4 matrix = FromTranslationRotationScale(local.translation, local.rotation, local.scale);
    const int parent = joints[j].parent;
    matrices[j] = parent < 0 ? matrix : At(matrices, parent) * matrix;
  }
  for (size_t j = 0; j < joints.size(); ++j) matrices[j] = matrices[j] * joints[j].inverse_bind;
  return matrices;
}

std::vector<Mat4> SkinningMatrices(const Avatar& avatar, const Clip& clip, float time_s) {
  const size_t joints = avatar.joints.size();
  int key = 0;
  float share = 0;
  FindKey(clip, time_s, &key, &share);
  const Transform* first = clip.transforms.data() + static_cast<size_t>(key) * joints;
  std::vector<Transform> local(first, first + joints);
  for (size_t j = 0; share > 0 && j < joints; ++j) local[j] = Mix(first[j], first[joints + j], share);
  return SkinningMatrices(avatar.joints, local);
}

std::vector<Vec3> SkinnedPositions(const Mesh& mesh, const std::vector<Mat4>& matrices) {
  std::vector<Vec3> out = mesh.positions;
  if (mesh.joints.size() != mesh.positions.size()) return out;
  for (size_t i = 0; i < out.size(); ++i) {
    out[i] = TransformPoint(Blend(mesh.joints[i], mesh.weights[i], matrices), out[i]);
  }
  return out;
}

Mesh Skinned(const Mesh& mesh, const std::vector<Mat4>& matrices) {
  Mesh out = mesh;
  if (mesh.joints.size() != mesh.positions.size()) return out;
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Mat4 matrix = Blend(mesh.joints[i], mesh.weights[i], matrices);
    out.positions[i] = TransformPoint(matrix, mesh.positions[i]);
    if (!mesh.normals.empty()) out.normals[i] = TransformNormal(matrix, mesh.normals[i]);
  }
  return out;
}

const Clip* FindClip(const Avatar& avatar, const std::string& name) {
  for (const Clip& clip : avatar.clips) {
    if (clip.name == name) return &clip;
  }
  return nullptr;
}

}  // namespace flaneur
