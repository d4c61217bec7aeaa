// Bright towns are exposed less; how bright one is comes from what is seen of it, not from how it is made.
#include "pipeline/cli/town_brightness.h"

#include <gtest/gtest.h>

#include "tests/unit/pipeline/pack/small_tour.h"

namespace flaneur {
namespace {

constexpr float kGround = 0.5f, kWall = 0.3f;

Mesh Square(Vec3 from, Vec3 across, Vec3 up, int material) {
  Mesh mesh;
  mesh.material = material;
  mesh.positions = {from, from + across, from + across + up, from + up};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

// A large ground and a small wall of plain colours.
Scene GreyTown() {
  Scene town;
  town.materials.resize(2);
  town.materials[0].base_color = {kGround, kGround, kGround, 1};
  town.materials[1].base_color = {kWall, kWall, kWall, 1};
  town.meshes = {Square({0, 0, 0}, {0, 0, -90}, {90, 0, 0}, 0), Square({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, 1)};
  town.nodes.resize(2);
  town.nodes[0].meshes = {0};
  town.nodes[1].meshes = {1};
  return town;
}

TEST(TownBrightness, GroundAndWallsCountAlikeHoweverLargeTheyAre) {
  EXPECT_NEAR(BrightnessOf(GreyTown(), nullptr), (kGround + kWall) / 2, 1e-4f);
}

TEST(TownBrightness, IsTheSameOfColoursPicturesAndVertices) {
  Scene town = GreyTown();
  town.materials[0].base_color = {1, 1, 1, 1};
  town.meshes[0].colors.assign(4, {kGround, kGround, kGround, 1});
  EXPECT_NEAR(BrightnessOf(town, nullptr), (kGround + kWall) / 2, 1e-4f);
  const float plain = BrightnessOf(town, nullptr);
  town.images = {Png("cobbles", 4, 4)};
  town.materials[0].base_color_image = 0;
  EXPECT_LT(BrightnessOf(town, nullptr), plain) << "no picture returns all light";
}

TEST(TownBrightness, OnlyBrightTownsAreExposedLess) {
  EXPECT_EQ(ExposureFor(0.1f), 1) << "the demo's, for which the light is made";
  EXPECT_EQ(ExposureFor(0), 1);
  EXPECT_LT(ExposureFor(0.5f), 0.6f);
  EXPECT_GE(ExposureFor(1), 0.4f);
  EXPECT_LT(ExposureFor(0.4f) * 0.4f, ExposureFor(1) * 1) << "a brighter town stays a brighter picture";
}

}  // namespace
}  // namespace flaneur
