#include "pipeline/avatar/merge_joints.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <span>

namespace flaneur {
namespace {

constexpr int kPosesOfAClip = 12;
constexpr float kStill_m = 1e-4f;  // a joint that moves no farther on its parent

using Poses = std::vector<std::vector<Mat4>>;
using Joints = std::vector<uint16_t>;  // that stands for each one

// Keys in which some joint is farthest from where it begins: lids close for a moment only.
std::set<size_t> Extremes(const Clip& clip, size_t joints) {
  std::set<size_t> keys;
  for (size_t j = 0; j < joints; ++j) {
    float farthest = 0;
    size_t key = 0;
    for (size_t at = j; at < clip.transforms.size(); at += joints) {
      const float away = Length(clip.transforms[at].translation - clip.transforms[j].translation);
      if (away > farthest) farthest = away, key = at / joints;
    }
    if (farthest > kStill_m) keys.insert(key);
  }
  return keys;
}

Poses AllPoses(const Avatar& avatar) {
  Poses poses;
  const size_t joints = avatar.joints.size();
  for (const Clip& clip : avatar.clips) {
    for (const size_t key : Extremes(clip, joints))
      poses.push_back(SkinningMatrices(avatar.joints, std::span(clip.transforms).subspan(key * joints, joints)));
    for (int i = 0; i < kPosesOfAClip; ++i) {
      const float share = static_cast<float>(i) / kPosesOfAClip;
      poses.push_back(SkinningMatrices(avatar, clip, share * clip.duration_s));
    }
  }
  return poses;
}

struct Corner {
  Vec3 position;
  std::array<uint16_t, 4> joints;
  std::array<float, 4> weights;
};

// How far the corner is moved where other joints stand for its own.
float Displacement(const Corner& corner, const Joints& standing, const std::vector<Mat4>& pose) {
  Vec3 moved;
  for (size_t i = 0; i < 4; ++i) {
    const uint16_t own = corner.joints[i], other = standing[own];
    if (!(corner.weights[i] > 0) || own == other) continue;
    moved = moved + (TransformPoint(pose[other], corner.position) - TransformPoint(pose[own], corner.position)) *
                        corner.weights[i];
  }
  return Length(moved);
}

std::vector<Corner> CornersOf(const std::vector<Mesh>& meshes) {
  std::vector<Corner> corners;
  for (const Mesh& mesh : meshes) {
    if (mesh.joints.size() != mesh.positions.size()) continue;
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
      corners.push_back({mesh.positions[v], mesh.joints[v], mesh.weights[v]});
    }
  }
  return corners;
}

// The corners that each joint moves.
std::vector<std::vector<uint32_t>> MovedBy(const std::vector<Corner>& corners, size_t joints) {
  std::vector<std::vector<uint32_t>> moved(joints);
  for (size_t c = 0; c < corners.size(); ++c) {
    for (size_t i = 0; i < 4; ++i) {
      if (corners[c].weights[i] > 0) {
        moved[corners[c].joints[i]].push_back(static_cast<uint32_t>(c));
      }
    }
  }
  return moved;
}

// The greatest displacement of these corners, or more than `bound_m` as soon as one is farther.
float Greatest(const std::vector<Corner>& corners, const std::vector<uint32_t>& of, const Joints& standing,
               const Poses& poses, float bound_m) {
  float greatest = 0;
  for (const std::vector<Mat4>& pose : poses) {
    for (const uint32_t c : of) {
      greatest = std::max(greatest, Displacement(corners[c], standing, pose));
      if (greatest > bound_m) return greatest;
    }
  }
  return greatest;
}

void Replace(const Joints& standing, Mesh* mesh) {
  for (size_t v = 0; v < mesh->joints.size(); ++v) {
    std::array<uint16_t, 4> joints{};
    std::array<float, 4> weights{};
    size_t count = 0;
    for (size_t i = 0; i < 4; ++i) {
      if (!(mesh->weights[v][i] > 0)) continue;
      const uint16_t joint = standing[mesh->joints[v][i]];
      const size_t at = static_cast<size_t>(
          std::find(joints.begin(), joints.begin() + static_cast<std::ptrdiff_t>(count), joint) - joints.begin());
      joints[at] = joint;
      weights[at] += mesh->weights[v][i];
      count = std::max(count, at + 1);
    }
    mesh->joints[v] = joints;
    mesh->weights[v] = weights;
  }
}

}  // namespace

float MergeJoints(const Avatar& avatar, float bound_m, std::vector<Mesh>* meshes) {
  const Poses poses = AllPoses(avatar);
  const std::vector<Corner> corners = CornersOf(*meshes);
  std::vector<std::vector<uint32_t>> moved = MovedBy(corners, avatar.joints.size());
  Joints standing(avatar.joints.size());
  for (size_t j = 0; j < standing.size(); ++j) standing[j] = static_cast<uint16_t>(j);
  float greatest = 0;
  for (size_t j = standing.size(); j-- > 0;) {  // what hangs on a joint comes before it
    const int parent = avatar.joints[j].parent;
    if (parent < 0 || moved[j].empty()) continue;
    Joints tried = standing;
    for (uint16_t& joint : tried) {
      if (joint == j) joint = static_cast<uint16_t>(parent);
    }
    const float found = Greatest(corners, moved[j], tried, poses, bound_m);
    if (found > bound_m) continue;
    greatest = std::max(greatest, found);
    standing = std::move(tried);
    auto& joined = moved[static_cast<size_t>(parent)];
    joined.insert(joined.end(), moved[j].begin(), moved[j].end());
  }
  for (Mesh& mesh : *meshes) Replace(standing, &mesh);
  return greatest;
}

void DropIdleJoints(Avatar* avatar) {
  const size_t count = avatar->joints.size();
  if (count == 0) return;
  std::vector<bool> busy(count, false);
  const std::vector<Mesh*> meshes = AllMeshes(avatar);
  for (const Mesh* mesh : meshes) {
    for (size_t v = 0; v < mesh->joints.size(); ++v) {
      for (size_t i = 0; i < 4; ++i) {
        if (mesh->weights[v][i] > 0) busy[mesh->joints[v][i]] = true;
      }
    }
  }
  busy[0] = true;
  std::vector<uint16_t> to(count, 0);
  std::vector<Joint> kept;
  for (size_t j = count; j-- > 0;) {
    const int parent = avatar->joints[j].parent;
    if (busy[j] && parent >= 0) busy[static_cast<size_t>(parent)] = true;
  }
  for (size_t j = 0; j < count; ++j) {
    if (!busy[j]) continue;
    to[j] = static_cast<uint16_t>(kept.size());
    Joint joint = avatar->joints[j];
    if (joint.parent >= 0) joint.parent = to[static_cast<size_t>(joint.parent)];
    kept.push_back(std::move(joint));
  }
  for (Clip& clip : avatar->clips) {
    std::vector<Transform> transforms;
    for (size_t i = 0; i < clip.transforms.size(); ++i) {
      if (busy[i % count]) transforms.push_back(clip.transforms[i]);
    }
    clip.transforms = std::move(transforms);
  }
  for (Mesh* mesh : meshes) {
    for (auto& joints : mesh->joints) {
      for (uint16_t& joint : joints) joint = to[joint];
    }
  }
  avatar->joints = std::move(kept);
}

int CountJoints(const std::vector<Mesh>& meshes) {
  std::vector<bool> used;
  for (const Mesh& mesh : meshes) {
    for (size_t v = 0; v < mesh.joints.size(); ++v) {
      for (size_t i = 0; i < 4; ++i) {
        const size_t joint = mesh.joints[v][i];
        if (!(mesh.weights[v][i] > 0)) continue;
        if (used.size() <= joint) used.resize(joint + 1, false);
        used[joint] = true;
      }
    }
  }
  return static_cast<int>(std::count(used.begin(), used.end(), true));
}

}  // namespace flaneur
