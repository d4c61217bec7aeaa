#include "pipeline/core/reach.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

float Reach_m(const std::vector<Mesh>& meshes, const std::vector<Mat4>& pose) {
  float reach_m = 0;
  for (const Mesh& mesh : meshes) {
    for (const Vec3 p : SkinnedPositions(mesh, pose)) reach_m = std::max(reach_m, std::hypot(p.x, p.z));
  }
  return reach_m;
}

}  // namespace

float Reach_m(const AvatarLevels& levels, const std::vector<std::string>& clip_of_prop) {
  const Avatar& avatar = levels.avatar;
  float reach_m = avatar.radius_m;
  for (const Clip& clip : avatar.clips) {
    for (int key = 0; key < clip.keys; ++key) {
      const float time_s = clip.duration_s * static_cast<float>(key) / static_cast<float>(std::max(1, clip.keys - 1));
      const std::vector<Mat4> pose = SkinningMatrices(avatar, clip, time_s);
      for (const AvatarLevel& level : levels.levels) reach_m = std::max(reach_m, Reach_m(level.meshes, pose));
      for (size_t k = 0; k < avatar.props.size(); ++k) {
        const bool tool = k < clip_of_prop.size() && !clip_of_prop[k].empty();
        if (!tool || clip_of_prop[k] == clip.name) reach_m = std::max(reach_m, Reach_m(avatar.props[k].meshes, pose));
      }
    }
  }
  return reach_m;
}

}  // namespace flaneur
