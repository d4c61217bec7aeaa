#include "pipeline/io/up_axis.h"

#include <algorithm>
#include <array>

namespace flaneur {
namespace {

// A town is so many times wider than high, and a row of houses so much longer than deep that it is no town on its side.
constexpr double kFlat = 2.5;
constexpr double kLeastTown =
    20;  // in units, high and wide: what is smaller may be a wall, a door or a banner of a kit

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
  Point3 low, high;
  if (!ExtentOf(scene, &low, &high)) return false;
  const double x = high.x - low.x, y = high.z - low.z, z = high.y - low.y;  // as in glTF
  *thin = x < z ? UpAxis::kX : UpAxis::kZ;
  const double tall = std::min(y, std::max(x, z));
  return tall > kLeastTown && tall > kFlat * std::min(x, z);
}

}  // namespace flaneur
