#include "pipeline/io/up_axis.h"

#include <algorithm>
#include <array>

#include "runtime/base/array.h"

namespace flaneur {
namespace {

// A town is so many times wider than high, and a row of houses so much longer than deep that it is no town on its side.
constexpr float kFlat = 2.5f;
constexpr float kLeastTown = 20;  // in units, high and wide: what is smaller may be a wall, a door or a banner of a kit

}  // namespace

void StandUp(UpAxis up, Scene* scene) {
  Mat4 turn;
  const std::array<Vec3, 3> images{GltfFromGround(WithZUp(Vec3{1, 0, 0}, up)),
                                   GltfFromGround(WithZUp(Vec3{0, 1, 0}, up)),
                                   GltfFromGround(WithZUp(Vec3{0, 0, 1}, up))};
  for (size_t column = 0; column < 3; ++column)
    turn.m[column] = {images[column].x, images[column].y, images[column].z, 0};
  for (SceneNode& node : scene->nodes) node.world = turn * node.world;
}

bool LiesOnItsSide(const Scene& scene, UpAxis* thin) {
  Vec3 min{1e30f, 1e30f, 1e30f}, max = min * -1;
  for (const SceneNode& node : scene.nodes) {
    for (const int mesh : node.meshes) {
      for (const Vec3 position : At(scene.meshes, mesh).positions) {
        const Vec3 p = TransformPoint(node.world, position);
        min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
        max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
      }
    }
  }
  const Vec3 size = max - min;
  *thin = size.x < size.z ? UpAxis::kX : UpAxis::kZ;
  const float tall = std::min(size.y, std::max(size.x, size.z));
  return tall > kLeastTown && tall > kFlat * std::min(size.x, size.z);
}

}  // namespace flaneur
