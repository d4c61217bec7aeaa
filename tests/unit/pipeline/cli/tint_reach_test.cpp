#include "pipeline/cli/tint_reach.h"

#include <gtest/gtest.h>

#include "runtime/base/srgb.h"

namespace flaneur {
namespace {

// A unit square of two triangles, of this material, at this height.
Mesh Square(int material, float y) {
  Mesh mesh;
  mesh.material = material;
  mesh.positions = {{0, y, 0}, {1, y, 0}, {1, y, 1}, {0, y, 1}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

Material Plain(Vec3 srgb) {
  Material material;
  material.base_color = {LinearFromSrgb(srgb.x), LinearFromSrgb(srgb.y), LinearFromSrgb(srgb.z), 1};
  return material;
}

TEST(TintReach, IsTheShareOfTheSurfaceWithTheColour) {
  const Vec3 blue{0.2f, 0.3f, 0.5f}, linen{0.8f, 0.78f, 0.7f}, green{0.3f, 0.4f, 0.25f};
  Avatar avatar;
  avatar.materials = {Plain(blue), Plain(linen), Plain(green)};
  avatar.meshes = {Square(0, 0), Square(1, 1), Square(1, 2), Square(2, 3)};
  std::vector<float> shares;
  ASSERT_EQ(
      TintReach(avatar, {{blue, 0.1f, {green}}, {linen, 0.1f, {green}}, {{1, 0, 0}, 0.1f, {green}}}, &shares).message,
      "");
  EXPECT_NEAR(shares[0], 0.25f, 1e-5f);
  EXPECT_NEAR(shares[1], 0.5f, 1e-5f);
  EXPECT_EQ(shares[2], 0) << "nobody wears it";
}

TEST(TintReach, StaysWithinTheMaterialsThatATintIsBoundTo) {
  const Vec3 brown{0.4f, 0.25f, 0.15f};
  Avatar avatar;
  avatar.name = "child";
  avatar.materials = {Plain(brown), Plain(brown)};
  avatar.materials[0].name = "tunic";
  avatar.materials[1].name = "hair";
  avatar.meshes = {Square(0, 0), Square(1, 1)};
  const std::vector<Tint> tints(2, {brown, 0.1f, {{0, 1, 0}}});
  std::vector<float> shares;
  ASSERT_EQ(BindTints({{"tunic"}, {}}, &avatar).message, "");
  ASSERT_EQ(TintReach(avatar, tints, &shares).message, "");
  EXPECT_NEAR(shares[0], 0.5f, 1e-5f) << "the hair, of the same colour, stays";
  EXPECT_NEAR(shares[1], 1, 1e-5f) << "bound to nothing";
  EXPECT_EQ(BindTints({{"tunick"}}, &avatar).message,
            "avatar 'child': a tint is bound to the material 'tunick', which it has not; it has: tunic, hair");
}

TEST(TintReach, MainColoursAreThoseOfTheClothsAndTheLargestComesFirst) {
  const Vec3 blue{0.2f, 0.3f, 0.5f}, linen{0.8f, 0.78f, 0.7f};
  Avatar avatar;
  avatar.materials = {Plain(blue), Plain(linen), Plain(blue + Vec3{0.02f, 0.02f, 0.02f}), Plain({0.9f, 0.1f, 0.1f})};
  for (int k = 0; k < 12; ++k) avatar.meshes.push_back(Square(k < 4 ? 0 : k < 8 ? 2 : 1, static_cast<float>(k)));
  Mesh button = Square(3, 20);
  for (Vec3& p : button.positions) p = p * 0.2f;
  avatar.meshes.push_back(button);
  std::vector<MainColor> colors;
  ASSERT_EQ(MainColors(avatar, &colors).message, "");
  ASSERT_EQ(colors.size(), 2u) << "a button is no cloth";
  EXPECT_NEAR(colors[0].share, 0.66f, 0.01f);
  EXPECT_NEAR(colors[0].color.x, 0.21f, 0.005f) << "both blues";
  EXPECT_NEAR(colors[1].color.z, 0.7f, 0.005f);
}

TEST(TintReach, CountsVertexColours) {
  Avatar avatar;
  avatar.materials = {Plain({1, 1, 1})};
  avatar.meshes = {Square(0, 0)};
  const float red = LinearFromSrgb(0.6f);
  avatar.meshes[0].colors.assign(4, {red, 0, 0, 1});
  std::vector<float> shares;
  ASSERT_EQ(TintReach(avatar, {{{0.6f, 0, 0}, 0.1f, {{0, 0, 1}}}}, &shares).message, "");
  EXPECT_NEAR(shares[0], 1, 1e-5f);
}

TEST(TintReach, APictureThatCannotBeDecodedIsNamed) {
  Avatar avatar;
  avatar.name = "maid";
  avatar.images = {{"dress.png", "image/png", {1, 2, 3}}};
  avatar.materials = {Plain({1, 1, 1})};
  avatar.materials[0].base_color_image = 0;
  avatar.meshes = {Square(0, 0)};
  std::vector<float> shares;
  EXPECT_EQ(TintReach(avatar, {{{1, 0, 0}, 0.1f, {{0, 0, 1}}}}, &shares).message,
            "avatar 'maid': image 'dress.png' cannot be decoded");
}

}  // namespace
}  // namespace flaneur
