#include "pipeline/avatar/limit_joints.h"

#include <algorithm>
#include <cstdio>

#include "pipeline/avatar/merge_joints.h"
#include "pipeline/io/gltf_pose.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kFirst_m = 1e-5f, kMost_m = 0.05f;

Mat4 MatrixOf(const Transform& t) { return FromTranslationRotationScale(t.translation, t.rotation, t.scale); }

std::vector<bool> UsedJoints(Avatar* avatar) {
  std::vector<bool> used(avatar->joints.size(), false);
  for (const Mesh* mesh : AllMeshes(avatar)) {
    for (size_t v = 0; v < mesh->joints.size(); ++v) {
      for (size_t i = 0; i < 4; ++i) {
        if (mesh->weights[v][i] > 0) At(used, mesh->joints[v][i]) = true;
      }
    }
  }
  used[0] = true;
  return used;
}

// Leaves out joints that move no vertex; what hung on them hangs on what they hung on.
void KeepUsed(Avatar* avatar) {
  const std::vector<bool> used = UsedJoints(avatar);
  const size_t count = used.size();
  std::vector<int> to(count, -1), above(count, -1);
  std::vector<Joint> kept;
  for (size_t j = 0; j < count; ++j) {
    int parent = avatar->joints[j].parent;
    while (parent >= 0 && !At(used, parent)) parent = At(avatar->joints, parent).parent;
    above[j] = parent;
    if (!used[j]) continue;
    to[j] = Count(kept);
    kept.push_back(avatar->joints[j]);
    kept.back().parent = parent < 0 ? -1 : At(to, parent);
  }
  const auto joined = [&](const Transform* locals, size_t j) {
    Mat4 matrix = MatrixOf(locals[j]);
    for (int a = avatar->joints[j].parent; a != above[j]; a = At(avatar->joints, a).parent)
      matrix = MatrixOf(locals[a]) * matrix;
    return Decomposed(matrix);
  };
  std::vector<Transform> rest;
  for (const Joint& joint : avatar->joints) rest.push_back(joint.rest);
  for (size_t j = 0; j < count; ++j) {
    if (used[j] && avatar->joints[j].parent != above[j]) At(kept, to[j]).rest = joined(rest.data(), j);
  }
  for (Clip& clip : avatar->clips) {
    std::vector<Transform> transforms;
    for (int k = 0; k < clip.keys; ++k) {
      const Transform* key = clip.transforms.data() + static_cast<size_t>(k) * count;
      for (size_t j = 0; j < count; ++j) {
        if (!used[j]) continue;
        transforms.push_back(avatar->joints[j].parent == above[j] ? key[j] : joined(key, j));
      }
    }
    clip.transforms = std::move(transforms);
  }
  for (Mesh* mesh : AllMeshes(avatar)) {
    for (size_t v = 0; v < mesh->joints.size(); ++v) {
      for (size_t i = 0; i < 4; ++i) {
        uint16_t& joint = mesh->joints[v][i];
        joint = mesh->weights[v][i] > 0 ? static_cast<uint16_t>(At(to, joint)) : uint16_t{0};
      }
    }
  }
  avatar->joints = std::move(kept);
}

}  // namespace

bool LimitJoints(int most, Avatar* avatar, std::vector<std::string>* warnings) {
  const int before = Count(avatar->joints);
  if (before <= most) return true;
  KeepUsed(avatar);
  float moved_m = 0;
  for (float bound_m = kFirst_m; Count(avatar->joints) > most && bound_m <= kMost_m; bound_m *= 3) {
    moved_m = std::max(moved_m, MergeJoints(*avatar, bound_m, &avatar->meshes));
    for (AvatarProp& prop : avatar->props) moved_m = std::max(moved_m, MergeJoints(*avatar, bound_m, &prop.meshes));
    KeepUsed(avatar);
  }
  if (Count(avatar->joints) > most) return false;
  char text[160];
  std::snprintf(text, sizeof text, "its %d joints are reduced to %d, which moves no vertex by more than %.1f mm",
                before, Count(avatar->joints), 1000 * static_cast<double>(moved_m));
  warnings->push_back(text);
  return true;
}

}  // namespace flaneur
