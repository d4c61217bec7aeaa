#include "runtime/pack/reach.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

Vec3 Posed(const PackPrimitive& p, size_t i, const Mat4* pose) {
  Vec3 sum;
  for (size_t k = 0; k < 4; ++k) {
    const float weight = static_cast<float>(p.weights[i][k]) / 255;
    if (weight > 0) sum = sum + TransformPoint(pose[p.joints[i][k]], p.positions[i]) * weight;
  }
  return sum;
}

}  // namespace

// Pictures are taken from all sides, so many a turn: between two of them a point is farther out by a little.
float ReachOfPictures_m(const ImpostorLayout& impostor) {
  int most_px = 0;
  for (const ImpostorCell& c : impostor.cells)
    most_px = std::max({most_px, std::abs(c.origin_x - c.x), std::abs(c.x + c.width - c.origin_x)});
  const float between = std::cos(kPi / static_cast<float>(std::max(4, impostor.directions)));
  return static_cast<float>(most_px) * impostor.texel_m / between;
}

float PosedReach_m(const PackMesh& mesh, const PackClip& clip, int joints) {
  float reach_m = 0;
  const auto count = static_cast<size_t>(joints);
  for (const PackPrimitive& p : mesh.primitives) {
    if (p.joints.size() != p.positions.size() || p.weights.size() != p.positions.size()) continue;
    for (size_t frame = 0; frame + count <= clip.matrices.size(); frame += count) {
      for (size_t i = 0; i < p.positions.size(); ++i) {
        const Vec3 at = Posed(p, i, &clip.matrices[frame]);
        reach_m = std::max(reach_m, std::hypot(at.x, at.z));
      }
    }
  }
  return reach_m;
}

}  // namespace flaneur
