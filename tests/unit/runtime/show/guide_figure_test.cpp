#include "runtime/show/guide_figure.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/runtime/simulation/tour_town.h"

namespace flaneur {
namespace {

size_t Triangles(const PackMesh& mesh) {
  size_t triangles = 0;
  for (const PackPrimitive& p : mesh.primitives) triangles += p.indices.size() / 3;
  return triangles;
}

// Two levels of a slab of a person, each one triangle; joint 3 carries the back.
TourPack WithMeshes() {
  TourPack pack = TourTown(10);
  PackPrimitive body;
  body.positions = {{0, 1.3f, -0.2f}, {0.3f, 0, 0}, {-0.3f, 0, 0.1f}};
  body.normals.assign(3, {0, 0, 1});
  body.joints = {{3, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}};
  body.weights.assign(3, {255, 0, 0, 0});
  body.indices = {0, 1, 2};
  pack.meshes = {{{body}}, {{body}}};
  for (PackAvatar& avatar : pack.avatars) {
    avatar.levels[1].mesh = 1;
    avatar.levels[0].triangles = avatar.levels[1].triangles = 1;
    avatar.joints = 4;
  }
  return pack;
}

TEST(GuideFigure, CountsItsTrianglesInEveryLevel) {
  TourPack pack = WithMeshes();
  AddGuideFigure(&pack);
  ASSERT_EQ(pack.avatars.size(), 3u);
  const PackAvatar& figure = pack.avatars.back();
  EXPECT_EQ(figure.name, "monk");
  EXPECT_EQ(figure.share, 0);
  EXPECT_EQ(figure.impostor_of, 1);
  for (const PackLevel& level : figure.levels) {
    EXPECT_EQ(Triangles(pack.meshes[static_cast<size_t>(level.mesh)]), static_cast<size_t>(level.triangles));
    EXPECT_GT(level.triangles, 10);
  }
  EXPECT_EQ(Triangles(pack.meshes[0]), 1u) << "the townspeople stay as they are";
}

TEST(GuideFigure, IsSeenOverEverybodysHeadAndMovesWithTheBack) {
  TourPack pack = WithMeshes();
  AddGuideFigure(&pack);
  const PackAvatar& figure = pack.avatars.back();
  const PackPrimitive& banner = pack.meshes[static_cast<size_t>(figure.levels[0].mesh)].primitives.back();
  float highest_m = 0;
  for (size_t i = 0; i < banner.positions.size(); ++i) {
    highest_m = std::max(highest_m, banner.positions[i].y);
    EXPECT_LT(banner.positions[i].z, -0.2f) << "behind the back";
    EXPECT_EQ(banner.joints[i][0], 3);
  }
  EXPECT_GT(highest_m, 1.3f * figure.height_m);
}

// What has no geometry loaded walks by the same numbers.
TEST(GuideFigure, CostsTheSameWithoutGeometry) {
  TourPack with = WithMeshes(), without = WithMeshes();
  without.meshes.clear();
  AddGuideFigure(&with);
  AddGuideFigure(&without);
  for (size_t k = 0; k < 2; ++k)
    EXPECT_EQ(with.avatars.back().levels[k].triangles, without.avatars.back().levels[k].triangles);
}

TEST(GuideFigure, IsTheGuideAndNobodyElse) {
  TourPack pack = WithMeshes();
  AddGuideFigure(&pack);
  const Simulation s = Started(pack);
  EXPECT_EQ(std::count(s.town.crowd.avatar.begin(), s.town.crowd.avatar.end(), 2), 1);
  EXPECT_EQ(s.town.crowd.avatar[s.visitor.guide.index], 2);
  TourPack plain = WithMeshes();
  plain.guide.clear();
  AddGuideFigure(&plain);
  EXPECT_EQ(plain.avatars.size(), 2u);
}

}  // namespace
}  // namespace flaneur
